#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "trimtab/culling/frustum.h"
#include "trimtab/units/large_array.h"
#include "trimtab/units/simd.h"

namespace trimtab {

/// Boxes as six arrays, so that one instruction tests many: what Frustum::mayShow tells, box by box, at the
/// speed of reading them.
class BoxArrays {
 public:
  void clear() { resize(0); }
  /// New boxes are not set.
  void resize(std::size_t count);
  void set(std::size_t i, const Box& box);
  Box operator[](std::size_t i) const {
    return {side_[0][i], side_[1][i], side_[2][i], side_[3][i], side_[4][i], side_[5][i]};
  }
  std::size_t size() const { return size_; }
  std::size_t blocks() const { return (size_ + kBlock - 1) / kBlock; }
  /// minX, minY, minZ, maxX, maxY, maxZ; as long as whole blocks of kBlock are.
  const float* side(std::size_t i) const { return side_[i].data(); }
  /// No coordinate is further from 0. Not a number or infinite where one is.
  float reach() const { return reach_; }

  static constexpr std::size_t kBlock = 64;

 private:
  std::array<LargeArray<float>, 6> side_;
  std::size_t size_ = 0;
  float reach_ = 0;
};

/// How many blocks before its turn one is asked of memory; 0 where the processor does so better by itself.
std::size_t blocksAhead();

/// Frustum::mayShow for a block of boxes at a time: the same set at every level, to the box.
///
/// Planes are evaluated in single precision first; only boxes so near a plane that rounding could decide are
/// asked of `frustum`. A box with a coordinate that is infinite or not a number makes that all of them.
class BlockTest {
 public:
  /// Keeps references to both.
  BlockTest(const BoxArrays& boxes, const Frustum& frustum, SimdLevel level = simdLevel());
  /// A bit a box of the block, set where the box may show; 0 past the last box.
  std::uint64_t operator()(std::size_t block) const;
  /// visit(block, bits) of every block in order. For more boxes than the near caches hold: memory is asked
  /// for blocksAhead() of time.
  template <class Visit>
  void all(const Visit& visit) const {
    const std::size_t ahead = blocksAhead(), count = blocks();
    for (std::size_t block = 0; block < count; ++block) {
      if (ahead != 0) fetch(std::min(block + ahead, count - 1));
      visit(block, (*this)(block));
    }
  }
  /// Set only where all of the box is certainly inside of every plane.
  std::uint64_t wholly(std::size_t block) const;
  std::size_t blocks() const { return boxes_.blocks(); }

  /// A plane as one sees it from a box: a corner of each, by the signs of the normal.
  struct CornerPlane {
    const float* place[3];
    float normal[3];
    float offset;  ///< added to the sum over the corner: how far inside that is
  };
  struct Planes {
    std::array<CornerPlane, 5> corner;
    std::array<const float*, 6> sides;  ///< that any corner is of; null after the last
    float out;                          ///< the least of a box is less: certainly outside
    float sure;                         ///< greater: certainly not
  };
  /// Of one block: bits of boxes that are certainly outside, and of those certainly inside of all planes.
  struct Bits {
    std::uint64_t out = 0, sure = 0;
  };

 private:
  // In the class: a call that does nothing else is taken for one that does nothing.
  void fetch(std::size_t block) const {
    constexpr std::size_t kFloatsALine = 16;
    for (std::size_t i = 0; i < planes_.sides.size() && planes_.sides[i] != nullptr; ++i)
      for (std::size_t line = 0; line < BoxArrays::kBlock; line += kFloatsALine)
        __builtin_prefetch(planes_.sides[i] + block * BoxArrays::kBlock + line);
  }
  std::uint64_t there(std::size_t block) const;

  const BoxArrays& boxes_;
  const Frustum& frustum_;
  Planes planes_, farPlanes_;  ///< the latter by the corners that are furthest outside
  Bits (*test_)(const Planes&, std::size_t first);
};

}  // namespace trimtab
