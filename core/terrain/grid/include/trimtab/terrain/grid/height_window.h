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

/// Heights of a grid that need not be in memory. Thread-safe; no voids are left in them.
class HeightSource {
 public:
  virtual ~HeightSource() = default;
  virtual const PostGrid& posts() const = 0;
  /// Every `stride`-th post of the window, from its first, row by row; as many as fit.
  virtual void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const = 0;
  /// 1 where a post was a void and filled; the same order.
  virtual void readVoids(const PostWindow& window, std::uint32_t stride,
                         std::span<std::uint8_t> voids) const = 0;
  /// Whether a read failed, ever: what it gave is 0 m, and nothing made of it may be kept.
  virtual bool failed() const { return false; }
};

/// How many a read gives along one side.
constexpr std::uint32_t strided(std::uint32_t count, std::uint32_t stride) {
  return count == 0 ? 0 : (count - 1) / stride + 1;
}

/// Heights that are in memory; the grid must outlive it. `voids`: one a post, or empty.
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
