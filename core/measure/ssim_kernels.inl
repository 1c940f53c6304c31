/// 0.299 R + 0.587 G + 0.114 B, rounded, halves up: exact.
void lumaOf(const std::uint8_t* rgba, std::size_t pixels, std::uint8_t* luma) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint32_t thousands =
        299u * rgba[4 * i] + 587u * rgba[4 * i + 1] + 114u * rgba[4 * i + 2] + 500u;
    luma[i] = static_cast<std::uint8_t>((thousands >> 3) * 134218u >> 24);  // thousands / 1000 below 256,000
  }
}

// Sum and difference of the images instead of the images: where they are nearly equal, what is left of
// 1 - SSIM is then all in the difference, and does not drown in the rounding of the sum. Weighted is how far
// each pair of pixels lies from the middle one (w (l + r - 2 m), the middle's own weight is the rest of 1),
// so that a flat window has a variance of exactly 0.
void ssimRow(const std::uint8_t* a, const std::uint8_t* b, int columns, const SsimFilter& filter,
             float* planes, std::size_t pitch) {
  constexpr int kChunk = 256;
  alignas(64) float sum[kChunk + 16 + kSimdSlack], difference[kChunk + 16 + kSimdSlack];
  for (int first = 0; first < columns; first += kChunk) {
    const int count = columns - first < kChunk ? columns - first : kChunk;
    for (int i = 0; i < count + 10; ++i) {
      const int x = a[first + i], y = b[first + i];
      sum[i] = static_cast<float>(x + y - 255);
      difference[i] = static_cast<float>(x - y);
    }
    for (int i = count + 10; i < count + 10 + kWide; ++i) sum[i] = difference[i] = 0;
    for (int x = 0; x < count; x += kWide) {
      const Floats sm = load(sum + x + 5), dm = load(difference + x + 5);
      const Floats ssm = sm * sm, ddm = dm * dm;
      Floats s = sm, d = dm, ss = ssm, dd = ddm;
      for (int k = 1; k <= 5; ++k) {
        const Floats w = all(filter.weights[k]);
        const Floats s1 = load(sum + x + 5 - k), s2 = load(sum + x + 5 + k);
        const Floats d1 = load(difference + x + 5 - k), d2 = load(difference + x + 5 + k);
        s = fma(w, (s1 + s2) - (sm + sm), s);
        d = fma(w, (d1 + d2) - (dm + dm), d);
        ss = fma(w, fma(s1, s1, s2 * s2) - (ssm + ssm), ss);
        dd = fma(w, fma(d1, d1, d2 * d2) - (ddm + ddm), dd);
      }
      float* to = planes + first + x;
      store(to, s);
      store(to + pitch, d);
      store(to + 2 * pitch, ss);
      store(to + 3 * pitch, dd);
    }
  }
}

double ssimSum(const float* const* rows, std::size_t pitch, int columns, const SsimFilter& filter) {
  constexpr float kC1 = 0.01f * 255 * 0.01f * 255, kC2 = 0.03f * 255 * 0.03f * 255;
  double total = 0;
  for (int x = 0; x < columns; x += kWide) {
    Floats mean[kSsimPlanes];
    for (std::size_t p = 0; p < kSsimPlanes; ++p) {
      const std::size_t at = p * pitch + static_cast<std::size_t>(x);
      const Floats middle = load(rows[5] + at);
      mean[p] = middle;
      for (int k = 1; k <= 5; ++k)
        mean[p] = fma(all(filter.weights[k]),
                      (load(rows[5 - k] + at) + load(rows[5 + k] + at)) - (middle + middle), mean[p]);
    }
    const Floats sumVariance = larger(mean[2] - mean[0] * mean[0], Floats{});
    const Floats differenceVariance = larger(mean[3] - mean[1] * mean[1], Floats{});
    const Floats sumMean = mean[0] + 255.0f;
    // 2 ab = ((a + b)^2 - (a - b)^2) / 2 and a^2 + b^2 = ((a + b)^2 + (a - b)^2) / 2.
    const Floats m2 = sumMean * sumMean, d2 = mean[1] * mean[1];
    const Floats ssim = ((m2 - d2 + 2 * kC1) * (sumVariance - differenceVariance + 2 * kC2)) /
                        ((m2 + d2 + 2 * kC1) * (sumVariance + differenceVariance + 2 * kC2));
    total += sumOf(ssim, columns - x < kWide ? columns - x : kWide);
  }
  return total;
}
