#pragma once

#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/catalogue.h"

namespace trimtab::terrain {

/// Adds tiles made of `heights` for the buckets in the rectangle `where` (degrees) that have none, so that
/// static trees cover them too. A made tile has its bucket's number as its name and an error of at most a
/// fifteenth of the posts' distance. At a tile of scenery it has exactly that tile's border vertices. Between
/// two made tiles both compute the same vertices from the line between them. So no edge is open but at the
/// rim of `where`. A bucket that is all at sea level is made of "Ocean", any other of "Default". Tiles are
/// made again when the catalogue needs them, so `heights` must outlive it.
Result<Done> makeTiles(SceneryCatalogue& scenery, const HeightSource& heights, const Rectangle& where,
                       const Progress& progress);

}  // namespace trimtab::terrain
