#pragma once

#include <algorithm>

#include "trimtab/terrain/scenery/import.h"

namespace trimtab::test {

/// Everything that a bake reads of scenery, in one piece; `outside` counts what is beyond its tiles.
inline Result<terrain::HeightGrid> rasterised(const terrain::SceneryCatalogue& scenery,
                                              const terrain::PostGrid& posts) {
  auto source = terrain::SceneryHeights::open(scenery, posts, {});
  if (!source) return source.findings();
  terrain::HeightGrid grid{posts, std::vector<float>(posts.size()), 0, {}};
  std::vector<std::uint8_t> beyond(posts.size());
  if (auto read = (*source)->readRows(0, posts.rows, grid.heights, beyond); !read) return read.findings();
  grid.outside = static_cast<std::uint64_t>(std::count(beyond.begin(), beyond.end(), 1));
  auto image = (*source)->image({});
  if (!image) return image.findings();
  grid.image = std::move(image).value();
  return Result<terrain::HeightGrid>(std::move(grid), source.findings());
}

}  // namespace trimtab::test
