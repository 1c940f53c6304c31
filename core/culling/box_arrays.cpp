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
using CornerPlanes = BlockTest::CornerPlanes;
using BlockBits = BlockTest::Bits;

CornerPlanes cornerPlanes(const BoxArrays& boxes, const Frustum& frustum, bool far) {
  CornerPlanes planes;
  const Vec3 eye = frustum.eye();
  const double reach = double{boxes.reach()};
  const double eyeReach = std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z);
  // Frustum's own margin is at most this; four roundings of sums that are at most that long.
  const double margin = 1e-3 + 1e-6 * (eyeReach + 6 * reach);
  const double rounding = std::ldexp(4 * reach + eyeReach + 1, -20);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto& plane = frustum.planes()[i];
    const std::array<double, 3> n{plane.normal.x, plane.normal.y, plane.normal.z};
    CornerPlane& p = planes[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p.normal[axis] = static_cast<float>(n[axis]);
      p.corner[axis] = boxes.side((n[axis] > 0) != far ? axis + 3 : axis);
    }
    const double offset = plane.offset + dot(plane.normal, eye);
    p.out = static_cast<float>(offset - margin - rounding);
    p.sure = static_cast<float>(offset + rounding);
    // Infinite reach: nothing is certain, of which comparisons with NaN take care.
    if (!std::isfinite(reach)) p.out = p.sure = std::numeric_limits<float>::quiet_NaN();
  }
  return planes;
}

BlockBits testPortable(const CornerPlanes& planes, std::size_t first) {
  std::uint8_t out[kBlock] = {}, sure[kBlock];
  std::fill(std::begin(sure), std::end(sure), std::uint8_t{1});
  for (const CornerPlane& p : planes) {
    const float *x = p.corner[0] + first, *y = p.corner[1] + first, *z = p.corner[2] + first;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float sum = p.normal[0] * x[i] + (p.normal[1] * y[i] + p.normal[2] * z[i]);
      out[i] = static_cast<std::uint8_t>(out[i] | (sum < p.out));
      sure[i] = static_cast<std::uint8_t>(sure[i] & (sum > p.sure));
    }
  }
  BlockBits bits;
  for (std::size_t i = 0; i < kBlock; ++i) {
    bits.out |= std::uint64_t{out[i]} << i;
    bits.sure |= std::uint64_t{sure[i]} << i;
  }
  return bits;
}

#if TRIMTAB_X86
__attribute__((target("avx2,fma"))) BlockBits testAvx2(const CornerPlanes& planes, std::size_t first) {
  BlockBits bits;
  for (std::size_t i = 0; i < kBlock; i += 8) {
    __m256 out = _mm256_setzero_ps(), unsure = _mm256_setzero_ps();
    for (const CornerPlane& p : planes) {
      __m256 sum = _mm256_mul_ps(_mm256_set1_ps(p.normal[2]), _mm256_loadu_ps(p.corner[2] + first + i));
      sum = _mm256_fmadd_ps(_mm256_set1_ps(p.normal[1]), _mm256_loadu_ps(p.corner[1] + first + i), sum);
      sum = _mm256_fmadd_ps(_mm256_set1_ps(p.normal[0]), _mm256_loadu_ps(p.corner[0] + first + i), sum);
      out = _mm256_or_ps(out, _mm256_cmp_ps(sum, _mm256_set1_ps(p.out), _CMP_LT_OQ));
      unsure = _mm256_or_ps(unsure, _mm256_cmp_ps(sum, _mm256_set1_ps(p.sure), _CMP_NGT_UQ));
    }
    bits.out |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm256_movemask_ps(out))) << i;
    bits.sure |= static_cast<std::uint64_t>(static_cast<unsigned>(~_mm256_movemask_ps(unsure)) & 0xffu) << i;
  }
  return bits;
}

__attribute__((target("avx512f"))) BlockBits testAvx512(const CornerPlanes& planes, std::size_t first) {
  BlockBits bits;
  for (std::size_t i = 0; i < kBlock; i += 16) {
    unsigned out = 0, sure = 0xffffu;
    for (const CornerPlane& p : planes) {
      __m512 sum = _mm512_mul_ps(_mm512_set1_ps(p.normal[2]), _mm512_loadu_ps(p.corner[2] + first + i));
      sum = _mm512_fmadd_ps(_mm512_set1_ps(p.normal[1]), _mm512_loadu_ps(p.corner[1] + first + i), sum);
      sum = _mm512_fmadd_ps(_mm512_set1_ps(p.normal[0]), _mm512_loadu_ps(p.corner[0] + first + i), sum);
      out |= _mm512_cmp_ps_mask(sum, _mm512_set1_ps(p.out), _CMP_LT_OQ);
      sure &= _mm512_cmp_ps_mask(sum, _mm512_set1_ps(p.sure), _CMP_GT_OQ);
    }
    bits.out |= std::uint64_t{out} << i;
    bits.sure |= std::uint64_t{sure} << i;
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

BlockTest::BlockTest(const BoxArrays& boxes, const Frustum& frustum, SimdLevel level)
    : boxes_(boxes),
      frustum_(frustum),
      planes_(cornerPlanes(boxes, frustum, false)),
      farPlanes_(cornerPlanes(boxes, frustum, true)),
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
