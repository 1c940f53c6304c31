#pragma once

#include <cstdint>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// A rectangle of posts, rows from south.
struct PostWindow {
  std::uint32_t column = 0, row = 0, columns = 0, rows = 0;
  std::size_t size() const { return std::size_t{columns} * rows; }
  friend bool operator==(const PostWindow&, const PostWindow&) = default;
};

/// Heights of a grid that may be on disk, metres, with all voids filled. It is thread-safe.
class HeightSource {
 public:
  virtual ~HeightSource() = default;
  virtual const PostGrid& posts() const = 0;
  /// Reads every `stride`-th post of the window, from its first, row by row; see strided() for how many.
  /// `heights` must have that size.
  virtual void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const = 0;
  /// Reads, in the same order, 1 where a post was a void and was filled, else 0.
  virtual void readVoids(const PostWindow& window, std::uint32_t stride,
                         std::span<std::uint8_t> voids) const = 0;
  /// Tells whether any read has failed. Failed reads yield 0 m, so discard everything made from this source.
  virtual bool failed() const { return false; }
};

/// Returns how many of `count` posts a read with `stride` yields along one side.
constexpr std::uint32_t strided(std::uint32_t count, std::uint32_t stride) {
  return count == 0 ? 0 : (count - 1) / stride + 1;
}

/// Heights in memory; `grid` and `voids` must outlive this object. `voids`: one per post, or empty.
class GridHeights final : public HeightSource {
 public:
  explicit GridHeights(const HeightGrid& grid, std::span<const std::uint8_t> voids = {})
      : grid_(grid), voids_(voids) {}
  const PostGrid& posts() const override { return grid_.posts; }
  void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const override;
  void readVoids(const PostWindow& window, std::uint32_t stride,
                 std::span<std::uint8_t> voids) const override;

 private:
  const HeightGrid& grid_;
  std::span<const std::uint8_t> voids_;
};

}  // namespace trimtab::terrain
