// The frustum test of box_arrays.h for simd_levels.inl: a block of boxes against every plane.

BlockTest::Bits testBlock(const Planes& planes, std::size_t first) {
  constexpr std::size_t kVectors = kBlock / kWide;
  // A few vectors at a time, so that their sums stay in registers.
  constexpr std::size_t kTogether = kVectors < 4 ? kVectors : 4;
  BlockTest::Bits bits;
  const Floats out = all(planes.out), sure = all(planes.sure);
  for (std::size_t from = 0; from < kVectors; from += kTogether) {
    Floats least[kTogether];
    for (Floats& l : least) l = all(std::numeric_limits<float>::max());
    for (const CornerPlane& p : planes.corner) {
      const Floats x = all(p.normal[0]), y = all(p.normal[1]), z = all(p.normal[2]), offset = all(p.offset);
      for (std::size_t i = 0; i < kTogether; ++i) {
        const std::size_t at = first + (from + i) * kWide;
        const Floats sum =
            fma(x, load(p.place[0] + at), fma(y, load(p.place[1] + at), fma(z, load(p.place[2] + at), offset)));
        least[i] = smaller(sum, least[i]);
      }
    }
    for (std::size_t i = 0; i < kTogether; ++i) {
      bits.out |= std::uint64_t{bitsOfMask(least[i] < out)} << (from + i) * kWide;
      bits.sure |= std::uint64_t{bitsOfMask(least[i] > sure)} << (from + i) * kWide;
    }
  }
  return bits;
}
