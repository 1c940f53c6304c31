#pragma once

#include <memory>
#include <span>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

/// Adds the open sea, for which scenery has no tiles: a tree of a single node for each bucket that has no
/// tile and whose posts all lie at sea level. Returns `trees` itself if there is no such bucket. An apron
/// runs under the neighbours, because their borders on the sea are long straight edges that dip below it. The
/// counts include the sea.
std::shared_ptr<const StaticLodTerrain> withOpenSea(std::shared_ptr<const StaticLodTerrain> trees,
                                                    std::span<const SceneryMesh> tiles,
                                                    const HeightSource& heights);

}  // namespace trimtab::terrain
