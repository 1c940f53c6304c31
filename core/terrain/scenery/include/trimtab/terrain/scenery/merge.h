#pragma once

#include <optional>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/catalogue.h"

/// Scenery and elevation on one grid of posts over both: scenery's triangles where there are any, elevation
/// elsewhere, blended so that no step is left (SceneryHeights). Buckets without a tile get one that is made
/// of the heights and shares its neighbours' borders (makeTiles), so that static trees have no gap between
/// both kinds.
namespace trimtab::terrain {

/// Returns the grid over both. Without a distance its posts are as close as those of the finer source.
Result<PostGrid> postsOfBoth(const SceneryCatalogue& scenery, const PostGrid& elevation,
                             std::optional<Metres> distance);

/// Returns the part of such a grid that the elevation covers, in degrees, with longitudes as the grid counts
/// them.
Rectangle elevationsPart(const PostGrid& both, const PostGrid& elevation);

}  // namespace trimtab::terrain
