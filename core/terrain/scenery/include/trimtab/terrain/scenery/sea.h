#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// Finds the open sea in a grid of posts. Scenery has no tiles there, but it has none where the data end
/// either. So an area of posts that no tile covers is sea if at least half of its neighbours that a tile
/// covers are within 0.5 m of sea level. An area is made of posts that are neighbours in a row or a column.
/// It is found row by row from the south, and kept as stretches, each a part of one row.
class OpenSea {
 public:
  struct Stretch {
    std::uint32_t first = 0, end = 0;  ///< columns; `end` is one past the last
    std::uint32_t area = 0;            ///< number of the area that the stretch was first given to
  };

  /// Adds the row north of the last one. `heights` are in metres above sea level, NaN where unknown;
  /// `reached` is 1 at posts that a tile covers. All rows have the same length.
  void add(std::span<const float> heights, std::span<const std::uint8_t> reached);
  /// Call this after the last row. Before it, `isSea` is false and `posts` 0.
  void finish();

  /// Returns how many rows were added.
  std::uint32_t rows() const { return static_cast<std::uint32_t>(firstOfRow_.size()) - 1; }
  std::uint64_t posts() const { return posts_; }  ///< how many posts are sea
  /// Returns the parts of a row that no tile covers, from west to east. The row must have been added. The
  /// stretches move when a row is added.
  std::span<const Stretch> stretches(std::uint32_t row) const {
    return std::span(stretches_).subspan(firstOfRow_[row], firstOfRow_[row + 1] - firstOfRow_[row]);
  }
  /// Reports whether the area of a stretch is sea.
  bool isSea(const Stretch& stretch) const { return areas_[rootOf(stretch.area)].sea; }

 private:
  struct Area {
    std::uint32_t parent;
    std::uint64_t border = 0, level = 0, posts = 0;
    bool sea = false;
  };
  std::uint32_t rootOf(std::uint32_t area) const;
  void join(std::uint32_t a, std::uint32_t b);
  void meet(std::uint32_t area, float height);

  std::vector<Stretch> stretches_;
  std::vector<std::size_t> firstOfRow_{0};
  std::vector<Area> areas_;
  std::vector<float> below_;              ///< heights of the previous row
  std::vector<std::uint8_t> belowReach_;  ///< `reached` of the previous row
  std::uint64_t posts_ = 0;
};

/// Paints the posts of a stretch, sea or not, with the opaque colour of the sea. `row` has four bytes (RGBA)
/// for each post of the grid's row.
void paintSea(std::span<std::uint8_t> row, const OpenSea::Stretch& stretch);

}  // namespace trimtab::terrain
