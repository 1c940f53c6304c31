#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/voids.h"

namespace trimtab::test {

/// Fills the voids of a grid in memory, and returns how many posts were filled.
inline std::uint64_t fillVoids(terrain::HeightGrid& grid) {
  const std::size_t across = grid.posts.columns;
  terrain::VoidFill fill;
  fill.columns = grid.posts.columns;
  fill.rows = grid.posts.rows;
  fill.memory = grid.heights.size() * sizeof(float);
  fill.read = [&](std::uint32_t first, std::uint32_t rows, std::span<float> heights) -> Result<Done> {
    std::copy_n(grid.heights.begin() + static_cast<std::ptrdiff_t>(first * across), rows * across,
                heights.begin());
    return Done{};
  };
  fill.write = [&](std::uint32_t first, std::uint32_t, std::span<const float> heights) -> Result<Done> {
    std::copy(heights.begin(), heights.end(),
              grid.heights.begin() + static_cast<std::ptrdiff_t>(first * across));
    return Done{};
  };
  const auto filled = terrain::fillVoids(fill);
  return filled ? *filled : 0;
}

}  // namespace trimtab::test
