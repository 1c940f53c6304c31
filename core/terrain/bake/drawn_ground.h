#pragma once

#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Gives every placement without a height that of the ground as the finest patches draw it, so that nothing
/// floats above triangles or sinks below them: they may be metres from the bilinear heights between posts.
/// Placements off the grid stay as they are. Each page is read once.
Result<Done> standOnDrawnGround(PlacementList& list, const PatchTerrain& patches, const PostGrid& posts);

}  // namespace trimtab::terrain
