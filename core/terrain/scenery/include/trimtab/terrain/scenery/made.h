#pragma once

#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/catalogue.h"

namespace trimtab::terrain {

/// Adds tiles of `heights` for the buckets in `where` that have none, so that trees of scenery go on there:
/// named after their buckets, meshed to a fifteenth of the posts' distance. At a tile of scenery a made one
/// has that tile's own border vertices, none more and none less, and with its like it shares what both
/// compute from the line between them: no open edge but at the rim of `where`. Buckets that the grid has
/// nothing but sea level for are made of "Ocean", all else of "Default". They are made again when they are
/// needed and did not stay in the catalogue's memory: `heights` must live as long as it is asked.
Result<Done> makeTiles(SceneryCatalogue& scenery, const HeightSource& heights, const Rectangle& where,
                       const Progress& progress);

}  // namespace trimtab::terrain
