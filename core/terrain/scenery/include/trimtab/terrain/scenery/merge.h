#pragma once

#include <optional>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/catalogue.h"

/// Scenery and elevation side by side on one grid of posts over both: scenery's triangles where there are
/// any, elevation elsewhere, blended so that no step shows (SceneryHeights). Buckets without a tile get one
/// that is made of the heights and shares its neighbours' borders (makeTiles), so that trees close between
/// both kinds. Airports sit in their holes as ever.
namespace trimtab::terrain {

/// As close as the finer of the two has them, where no distance is given.
Result<PostGrid> postsOfBoth(const SceneryCatalogue& scenery, const PostGrid& elevation,
                             std::optional<Metres> distance);

/// Degrees that a grid over both has from the elevation, with longitudes as the grid counts them.
Rectangle elevationsPart(const PostGrid& both, const PostGrid& elevation);

}  // namespace trimtab::terrain
