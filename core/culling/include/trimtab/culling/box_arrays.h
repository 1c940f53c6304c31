#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "trimtab/culling/frustum.h"
#include "trimtab/units/large_array.h"
#include "trimtab/units/simd.h"

namespace trimtab {

/// Boxes as six arrays, so that one instruction tests many.
class BoxArrays {
 public:
  void clear() { resize(0); }
  /// Resizes the arrays. New boxes have no values yet.
  void resize(std::size_t count);
  void set(std::size_t i, const Box& box);
  Box operator[](std::size_t i) const {
    return {side_[0][i], side_[1][i], side_[2][i], side_[3][i], side_[4][i], side_[5][i]};
  }
  std::size_t size() const { return size_; }
  std::size_t blocks() const { return (size_ + kBlock - 1) / kBlock; }
  /// Returns an array: minX, minY, minZ, maxX, maxY, maxZ. It is as long as whole blocks of kBlock.
  const float* side(std::size_t i) const { return side_[i].data(); }
  /// Returns the largest absolute coordinate; not a number or infinite if a coordinate is.
  float reach() const { return reach_; }

  static constexpr std::size_t kBlock = 64;

 private:
  std::array<LargeArray<float>, 6> side_;
  std::size_t size_ = 0;
  float reach_ = 0;
};

/// Does what Frustum::mayShow does, for a block of boxes at a time, with the same result at every SIMD
/// level.
///
/// Planes are evaluated in single precision first; only boxes so near a plane that rounding could decide are
/// tested by `frustum`. If a coordinate is infinite or not a number, these are all boxes.
class BlockTest {
 public:
  /// Both arguments must outlive it.
  BlockTest(const BoxArrays& boxes, const Frustum& frustum, SimdLevel level = simdLevel());
  /// Returns a bit for each box of the block, set if the box may show; 0 past the last box.
  std::uint64_t operator()(std::size_t block) const;
  /// Returns a bit for each box, set only if all of it is certainly inside every plane.
  std::uint64_t wholly(std::size_t block) const;
  std::size_t blocks() const { return boxes_.blocks(); }

  /// A plane, and for each box the corner by which it is tested, by the signs of the normal.
  struct CornerPlane {
    const float* place[3];
    float normal[3];
    float offset;  ///< added to the sum over the corner gives how far inside that is
  };
  struct Planes {
    std::array<CornerPlane, 5> corner;
    std::array<const float*, 6> sides;  ///< those that corners read; null after the last
    float out;                          ///< a box whose least sum is below is certainly outside
    float sure;                         ///< a box whose least sum is above is certainly not
  };
  /// Bits of the boxes of a block that are certainly outside, and of those certainly inside all planes.
  struct Bits {
    std::uint64_t out = 0, sure = 0;
  };

 private:
  std::uint64_t there(std::size_t block) const;

  const BoxArrays& boxes_;
  const Frustum& frustum_;
  Planes planes_, farPlanes_;  ///< farPlanes_ by the corners that are furthest outside
  Bits (*test_)(const Planes&, std::size_t first);
};

}  // namespace trimtab
