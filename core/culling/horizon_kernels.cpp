#include "horizon_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "horizon_geometry.h"

#if defined(__x86_64__)
#define TRIMTAB_X86 1
#endif

namespace trimtab::horizon {
namespace {

#define TRIMTAB_INLINE inline __attribute__((always_inline))

TRIMTAB_INLINE void projectAll(const Projection& p, int count, float* __restrict forward, float* __restrict u,
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

TRIMTAB_INLINE void imagesOf(int side, const TileRelief::Part& part, const std::array<float, 3>& from,
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

TRIMTAB_INLINE int trendOf(const float* values, int count) {
  int rising = 0;
  for (int i = 0; i + 1 < count; ++i) rising += values[i + 1] >= values[i];
  return rising == count - 1 ? 1 : rising == 0 ? -1 : 0;
}

TRIMTAB_INLINE void lowerAll(float* w, int count, float up, float forwards, float inverse) {
  for (int i = 0; i < count; ++i) w[i] -= (up + std::abs(w[i]) * forwards) * inverse;
}

TRIMTAB_INLINE int firstNotAboveOf(const float* values, int count, float limit) {
  for (int i = 0; i < count; i += 16) {
    unsigned low = 0;
    for (unsigned k = 0; k < 16; ++k)
      low |= static_cast<unsigned>(!(values[i + static_cast<int>(k)] > limit)) << k;
    if (low != 0) return std::min(i + std::countr_zero(low), count);
  }
  return count;
}

TRIMTAB_INLINE void raiseAll(float* __restrict values, const float* __restrict to, int count) {
  for (int i = 0; i < count; ++i) values[i] = values[i] < to[i] ? to[i] : values[i];
}

TRIMTAB_INLINE void erodeAll(float* values, int count, int width) {
  int done = 1;
  const auto least = [&](int step) {
    count -= step;
    for (int i = 0; i < count; ++i) values[i] = std::min(values[i], values[i + step]);
  };
  for (; 2 * done <= width; done *= 2) least(done);
  if (done < width) least(width - done);
}

#define TRIMTAB_KERNELS(NAME, TARGET)                                                                \
  TARGET void project##NAME(const Projection& p, int count, float* f, float* u, float* w) {          \
    projectAll(p, count, f, u, w);                                                                   \
  }                                                                                                  \
  TARGET void images##NAME(int side, const TileRelief::Part& part, const std::array<float, 3>& from, \
                           BoxImages& images) {                                                      \
    imagesOf(side, part, from, images);                                                              \
  }                                                                                                  \
  TARGET int trend##NAME(const float* values, int count) {                                           \
    return trendOf(values, count);                                                                   \
  }                                                                                                  \
  TARGET void lower##NAME(float* w, int count, float up, float forwards, float inverse) {            \
    lowerAll(w, count, up, forwards, inverse);                                                       \
  }                                                                                                  \
  TARGET int firstNotAbove##NAME(const float* v, int count, float limit) {                           \
    return firstNotAboveOf(v, count, limit);                                                         \
  }                                                                                                  \
  TARGET void raise##NAME(float* v, const float* to, int count) {                                    \
    raiseAll(v, to, count);                                                                          \
  }                                                                                                  \
  TARGET void erode##NAME(float* v, int count, int width) {                                          \
    erodeAll(v, count, width);                                                                       \
  }                                                                                                  \
  constexpr Kernels k##NAME{project##NAME,       images##NAME, trend##NAME, lower##NAME,             \
                            firstNotAbove##NAME, raise##NAME,  erode##NAME};

TRIMTAB_KERNELS(Portable, )
#if TRIMTAB_X86
TRIMTAB_KERNELS(Avx2, __attribute__((target("avx2"))))
TRIMTAB_KERNELS(Avx512, __attribute__((target("avx512f,avx512vl,avx512dq,prefer-vector-width=512"))))
#endif

}  // namespace

const Kernels& kernels(SimdLevel atMost) {
#if TRIMTAB_X86
  static const bool hasAll = __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  const SimdLevel level = std::min(atMost, simdLevel());
  if (level == SimdLevel::avx512 && hasAll) return kAvx512;
  if (level != SimdLevel::portable) return kAvx2;
#else
  (void)atMost;
#endif
  return kPortable;
}

}  // namespace trimtab::horizon
