#include "trimtab/culling/box_arrays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace trimtab {
namespace {

constexpr std::size_t kBlock = BoxArrays::kBlock;

using CornerPlane = BlockTest::CornerPlane;
using Planes = BlockTest::Planes;

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

}  // namespace

#define TRIMTAB_KERNELS "core/culling/box_kernels.inl"
#include "trimtab/units/simd_levels.inl"

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
    // Once NaN, the reach stays NaN.
    if (!std::isnan(reach_) && !(away <= reach_)) reach_ = away;
  }
}

BlockTest::BlockTest(const BoxArrays& boxes, const Frustum& frustum, SimdLevel level)
    : boxes_(boxes),
      frustum_(frustum),
      planes_(planesFor(boxes, frustum, false)),
      farPlanes_(planesFor(boxes, frustum, true)),
      test_(TRIMTAB_PICK(level, testBlock)) {}

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
