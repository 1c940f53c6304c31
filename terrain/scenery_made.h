#pragma once

#include <vector>

#include "trimtab/terrain/post_grid.h"
#include "trimtab/terrain/rectangle.h"
#include "trimtab/terrain/scenery_catalogue.h"

namespace trimtab::terrain {

/// Tiles of `grid` for the buckets in `where` that have none, so that trees of scenery go on there: named
/// after their buckets, meshed to a fifteenth of the posts' distance. At a tile of scenery a made one has
/// that tile's own border vertices, none more and none less, and with its like it shares what both compute
/// from the line between them: no open edge but at the rim of `where`. Buckets that the grid has nothing but
/// sea level for are made of "Ocean", all else of "Default".
Result<std::vector<SceneryMesh>> madeTiles(const SceneryCatalogue& scenery, const HeightGrid& grid,
                                           const Rectangle& where);

}  // namespace trimtab::terrain
