#pragma once

#include <span>
#include <vector>

#include "trimtab/terrain/post_grid.h"
#include "trimtab/terrain/scenery.h"

namespace trimtab::terrain {

/// Rectangle, degrees; longitudes on one side of the earth.
struct Rectangle {
  double west = 0, south = 0, east = 0, north = 0;
};

/// Tiles of `grid` for the buckets in `where` that have none, so that trees of scenery go on there: named
/// after their buckets, meshed to a fifteenth of the posts' distance. At a tile of scenery a made one has
/// that tile's own border vertices, none more and none less, and with its like it shares what both compute
/// from the line between them: no open edge but at the rim of `where`. Buckets that the grid has nothing but
/// sea level for are made of "Ocean", all else of "Default".
std::vector<SceneryMesh> madeTiles(std::span<const SceneryMesh> scenery, const HeightGrid& grid,
                                   const Rectangle& where);

}  // namespace trimtab::terrain
