#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// Finds open sea, for which scenery has no tiles. A connected area that no tile reaches is sea if at least
/// half of its border meets tiles at sea level. Areas are found row by row from the south, and kept as
/// stretches of rows.
class OpenSea {
 public:
  struct Stretch {
    std::uint32_t first = 0, end = 0;  ///< columns; `end` is one past the last
    std::uint32_t area = 0;
  };

  /// Adds the next row from the south: heights, NaN if there is none, and 1 at posts that a tile reaches.
  void add(std::span<const float> heights, std::span<const std::uint8_t> reached);
  /// Call this after the last row; only then isSea() is known.
  void finish();

  std::uint32_t rows() const { return static_cast<std::uint32_t>(firstOfRow_.size()) - 1; }
  std::uint64_t posts() const { return posts_; }  ///< how many posts are sea
  /// Returns the stretches of a row that no tile reaches, from the west.
  std::span<const Stretch> stretches(std::uint32_t row) const {
    return std::span(stretches_).subspan(firstOfRow_[row], firstOfRow_[row + 1] - firstOfRow_[row]);
  }
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
  std::vector<std::uint8_t> belowReach_;  ///< 1 at its posts that a tile reaches
  std::uint64_t posts_ = 0;
};

/// Paints the posts of a stretch in a row of RGBA with the colour of the sea.
void paintSea(std::span<std::uint8_t> row, const OpenSea::Stretch& stretch);

}  // namespace trimtab::terrain
