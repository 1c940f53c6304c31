#include "trimtab/culling/box_arrays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#define TRIMTAB_X86 1
#endif

namespace trimtab {
namespace {

constexpr std::size_t kBlock = BoxArrays::kBlock;

using CornerPlane = BlockTest::CornerPlane;
using Planes = BlockTest::Planes;
using BlockBits = BlockTest::Bits;

Planes planesFor(const BoxArrays& boxes, const Frustum& frustum, bool far) {
  Planes planes{};
  std::array<bool, 6> read{};
  const Vec3 eye = frustum.eye();
  const double reach = double{boxes.reach()};
  const double eyeReach = std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z);
  for (std::size_t i = 0; i < planes.corner.size(); ++i) {
    const auto& plane = frustum.planes()[i];
    const std::array<double, 3> n{plane.normal.x, plane.normal.y, plane.normal.z};
    const double offset = plane.offset + dot(plane.normal, eye);
    // One that is not a number drops nothing.
    const bool finite =
        std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2]) && std::isfinite(offset);
    BlockTest::CornerPlane& p = planes.corner[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p.normal[axis] = finite ? static_cast<float>(n[axis]) : 0;
      const std::size_t side = (n[axis] > 0) != far ? axis + 3 : axis;
      p.place[axis] = boxes.side(side);
      read[side] = true;
    }
    p.offset = finite ? static_cast<float>(-offset) : std::numeric_limits<float>::max();
  }
  for (std::size_t side = 0, count = 0; side < read.size(); ++side)
    if (read[side]) planes.sides[count++] = boxes.side(side);
  // Frustum's own margin is at most this; five roundings of sums that are at most that long.
  const double margin = 1e-3 + 1e-6 * (eyeReach + 6 * reach);
  const double rounding = std::ldexp(4 * reach + eyeReach + 1, -20);
  planes.out = static_cast<float>(-margin - rounding);
  planes.sure = static_cast<float>(rounding);
  // Infinite reach: nothing is certain, of which comparisons with NaN take care.
  if (!std::isfinite(reach) || !std::isfinite(eyeReach))
    planes.out = planes.sure = std::numeric_limits<float>::quiet_NaN();
  return planes;
}

BlockBits testPortable(const Planes& planes, std::size_t first) {
  float least[kBlock];
  std::fill(std::begin(least), std::end(least), std::numeric_limits<float>::max());
  for (const CornerPlane& p : planes.corner) {
    const float *x = p.place[0] + first, *y = p.place[1] + first, *z = p.place[2] + first;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float sum = p.normal[0] * x[i] + (p.normal[1] * y[i] + (p.normal[2] * z[i] + p.offset));
      least[i] = sum < least[i] ? sum : least[i];
    }
  }
  BlockBits bits;
  for (std::size_t i = 0; i < kBlock; ++i) {
    bits.out |= std::uint64_t{least[i] < planes.out} << i;
    bits.sure |= std::uint64_t{least[i] > planes.sure} << i;
  }
  return bits;
}

#if TRIMTAB_X86
__attribute__((target("avx2,fma"))) BlockBits testAvx2(const Planes& planes, std::size_t first) {
  BlockBits bits;
  const __m256 out = _mm256_set1_ps(planes.out), sure = _mm256_set1_ps(planes.sure);
  for (std::size_t i = 0; i < kBlock; i += 8) {
    __m256 least = _mm256_set1_ps(std::numeric_limits<float>::max());
    for (const CornerPlane& p : planes.corner) {
      __m256 sum = _mm256_fmadd_ps(_mm256_set1_ps(p.normal[2]), _mm256_loadu_ps(p.place[2] + first + i),
                                   _mm256_set1_ps(p.offset));
      sum = _mm256_fmadd_ps(_mm256_set1_ps(p.normal[1]), _mm256_loadu_ps(p.place[1] + first + i), sum);
      sum = _mm256_fmadd_ps(_mm256_set1_ps(p.normal[0]), _mm256_loadu_ps(p.place[0] + first + i), sum);
      least = _mm256_min_ps(sum, least);
    }
    bits.out |=
        std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(least, out, _CMP_LT_OQ)))}
        << i;
    bits.sure |=
        std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(least, sure, _CMP_GT_OQ)))}
        << i;
  }
  return bits;
}

__attribute__((target("avx512f"))) BlockBits testAvx512(const Planes& planes, std::size_t first) {
  BlockBits bits;
  __m512 least[kBlock / 16];
  for (__m512& l : least) l = _mm512_set1_ps(std::numeric_limits<float>::max());
  for (const CornerPlane& p : planes.corner) {
    const __m512 x = _mm512_set1_ps(p.normal[0]), y = _mm512_set1_ps(p.normal[1]),
                 z = _mm512_set1_ps(p.normal[2]), offset = _mm512_set1_ps(p.offset);
    for (std::size_t i = 0; i < kBlock / 16; ++i) {
      const std::size_t at = first + 16 * i;
      __m512 sum = _mm512_fmadd_ps(z, _mm512_loadu_ps(p.place[2] + at), offset);
      sum = _mm512_fmadd_ps(y, _mm512_loadu_ps(p.place[1] + at), sum);
      sum = _mm512_fmadd_ps(x, _mm512_loadu_ps(p.place[0] + at), sum);
      least[i] = _mm512_mask_min_ps(sum, 0xffff, sum, least[i]);  // without a mask g++ 12 warns
    }
  }
  const __m512 out = _mm512_set1_ps(planes.out), sure = _mm512_set1_ps(planes.sure);
  for (std::size_t i = 0; i < kBlock / 16; ++i) {
    bits.out |= std::uint64_t{_mm512_cmp_ps_mask(least[i], out, _CMP_LT_OQ)} << 16 * i;
    bits.sure |= std::uint64_t{_mm512_cmp_ps_mask(least[i], sure, _CMP_GT_OQ)} << 16 * i;
  }
  return bits;
}
#endif

}  // namespace

void BoxArrays::resize(std::size_t count) {
  size_ = count;
  const std::size_t padded = (count + kBlock - 1) / kBlock * kBlock;
  for (auto& side : side_) side.resize(padded);
  if (count == 0) reach_ = 0;
}

void BoxArrays::set(std::size_t i, const Box& box) {
  const std::array<float, 6> values{box.minX, box.minY, box.minZ, box.maxX, box.maxY, box.maxZ};
  for (std::size_t k = 0; k < values.size(); ++k) {
    side_[k][i] = values[k];
    const float away = std::abs(values[k]);
    // What is not a number stays.
    if (!std::isnan(reach_) && !(away <= reach_)) reach_ = away;
  }
}

SimdLevel simdLevel() {
#if TRIMTAB_X86
  static const SimdLevel level = __builtin_cpu_supports("avx512f") ? SimdLevel::avx512
                                 : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
                                     ? SimdLevel::avx2
                                     : SimdLevel::portable;
  return level;
#else
  return SimdLevel::portable;
#endif
}

std::size_t blocksAhead() {
#if TRIMTAB_X86
  // Six streams are more than an Intel processor looks ahead of by itself: eight blocks are 1.15 times the
  // boxes a second from memory on a Xeon, 1.5 from the last cache, 0.85 from the first two. An AMD EPYC does
  // look ahead, and being asked costs it a quarter of its speed.
  static const std::size_t blocks = __builtin_cpu_is("intel") ? 8 : 0;
  return blocks;
#else
  return 0;
#endif
}

BlockTest::BlockTest(const BoxArrays& boxes, const Frustum& frustum, SimdLevel level)
    : boxes_(boxes),
      frustum_(frustum),
      planes_(planesFor(boxes, frustum, false)),
      farPlanes_(planesFor(boxes, frustum, true)),
      test_(testPortable) {
#if TRIMTAB_X86
  level = std::min(level, simdLevel());
  if (level == SimdLevel::avx2) test_ = testAvx2;
  if (level == SimdLevel::avx512) test_ = testAvx512;
#else
  (void)level;
#endif
}

std::uint64_t BlockTest::there(std::size_t block) const {
  const std::size_t left = boxes_.size() - block * kBlock;
  return left < kBlock ? (std::uint64_t{1} << left) - 1 : ~std::uint64_t{0};
}

std::uint64_t BlockTest::wholly(std::size_t block) const {
  const Bits bits = test_(farPlanes_, block * kBlock);
  return bits.sure & ~bits.out & there(block);
}

std::uint64_t BlockTest::operator()(std::size_t block) const {
  const std::size_t first = block * kBlock;
  const Bits bits = test_(planes_, first);
  std::uint64_t in = bits.sure & ~bits.out;
  for (std::uint64_t ask = there(block) & ~bits.out & ~bits.sure; ask != 0; ask &= ask - 1) {
    const int i = std::countr_zero(ask);
    if (frustum_.mayShow(boxes_[first + static_cast<std::size_t>(i)])) in |= std::uint64_t{1} << i;
  }
  return in & there(block);
}

}  // namespace trimtab
