// The inner loops of horizon_kernels.h, for simd_levels.inl. The compiler makes vectors of these plain loops.

void project(const Projection& p, int count, float* __restrict forward, float* __restrict u,
                               float* __restrict w) {
  const float* __restrict a = p.a, * __restrict b = p.b, * __restrict z = p.z;
  const float signF = p.signF, signL = p.signL, perT = p.perT;
  for (int from = 0; from < count; from += 16)
    for (int i = from; i < from + 16; ++i) {
      const float f = signF * a[i], inverse = 1 / f;
      forward[i] = f;
      u[i] = (signL * b[i] * inverse + 1) * perT;
      w[i] = z[i] * inverse;
    }
}

template <int Side>
TRIMTAB_INLINE void imagesFrom(const TileRelief::Part& p, const std::array<float, 3>& from,
                               BoxImages& __restrict images) {
  const auto [x, y, z] = from;
  for (std::size_t i = 0; i < p.top.size(); ++i) {
    const BoxImage image(turned(Side, p.minX[i] + x, p.maxX[i] + x, p.minY[i] + y, p.maxY[i] + y),
                         p.top[i] + z);
    images.t0[i] = image.t0;
    images.t1[i] = image.t1;
    images.w[i] = image.w;
  }
}

void images(int side, const TileRelief::Part& part, const std::array<float, 3>& from,
                             BoxImages& images) {
  switch (side) {
    case 0:
      return imagesFrom<0>(part, from, images);
    case 1:
      return imagesFrom<1>(part, from, images);
    case 2:
      return imagesFrom<2>(part, from, images);
    default:
      return imagesFrom<3>(part, from, images);
  }
}

int trend(const float* values, int count) {
  int rising = 0;
  for (int i = 0; i + 1 < count; ++i) rising += values[i + 1] >= values[i];
  return rising == count - 1 ? 1 : rising == 0 ? -1 : 0;
}

void lower(float* w, int count, float up, float forwards, float inverse) {
  for (int i = 0; i < count; ++i) w[i] -= (up + std::abs(w[i]) * forwards) * inverse;
}

int firstNotAbove(const float* values, int count, float limit) {
  for (int i = 0; i < count; i += 16) {
    unsigned low = 0;
    for (unsigned k = 0; k < 16; ++k)
      low |= static_cast<unsigned>(!(values[i + static_cast<int>(k)] > limit)) << k;
    if (low != 0) return std::min(i + std::countr_zero(low), count);
  }
  return count;
}

void raise(float* __restrict values, const float* __restrict to, int count) {
  for (int i = 0; i < count; ++i) values[i] = values[i] < to[i] ? to[i] : values[i];
}

void erode(float* values, int count, int width) {
  int done = 1;
  const auto least = [&](int step) {
    count -= step;
    for (int i = 0; i < count; ++i) values[i] = std::min(values[i], values[i + step]);
  };
  for (; 2 * done <= width; done *= 2) least(done);
  if (done < width) least(width - done);
}

constexpr Kernels kernels{project, images, trend, lower, firstNotAbove, raise, erode};
