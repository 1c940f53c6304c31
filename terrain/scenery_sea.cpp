#include "trimtab/terrain/scenery_sea.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/terrain/scenery.h"

namespace trimtab::terrain {

namespace {

constexpr float kSeaLevelM = 0.5f;

}  // namespace

std::uint64_t fillOpenSea(HeightGrid& grid, const std::vector<std::uint8_t>& reached) {
  const std::uint32_t columns = grid.posts.columns, rows = grid.posts.rows;
  const auto colour = materialColour("Ocean");
  std::vector<std::uint8_t> seen(reached);
  std::uint64_t sea = 0;
  std::vector<std::size_t> area;
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first] != 0) continue;
    std::uint64_t border = 0, level = 0;
    area.assign(1, first);
    seen[first] = 1;
    for (std::size_t i = 0; i < area.size(); ++i) {
      const std::size_t post = area[i];
      const std::size_t row = post / columns, column = post % columns;
      std::array<std::size_t, 4> beside;
      std::size_t count = 0;
      if (column > 0) beside[count++] = post - 1;
      if (column + 1 < columns) beside[count++] = post + 1;
      if (row > 0) beside[count++] = post - columns;
      if (row + 1 < rows) beside[count++] = post + columns;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t next = beside[k];
        if (reached[next] != 0) {
          const float height = grid.heights[next];
          border += std::isnan(height) ? 0 : 1;
          level += std::abs(height) <= kSeaLevelM ? 1 : 0;
        } else if (seen[next] == 0) {
          seen[next] = 1;
          area.push_back(next);
        }
      }
    }
    if (border == 0 || 2 * level < border) continue;
    for (const std::size_t post : area) {
      grid.heights[post] = 0;
      std::copy_n(colour.data(), 3, &grid.image[post * 4]);
      grid.image[post * 4 + 3] = 255;
    }
    sea += area.size();
  }
  grid.outside -= std::min<std::uint64_t>(sea, grid.outside);
  return sea;
}

}  // namespace trimtab::terrain
