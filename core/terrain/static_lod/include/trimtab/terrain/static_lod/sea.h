#pragma once

#include <memory>
#include <span>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

/// Scenery has no tiles for the open sea. One tree of a single node for each bucket that has no tile and
/// whose posts all lie at sea level: `trees` itself where there is none such. An apron runs under the
/// neighbours, whose borders on the sea are long straight edges and so dip below it. The counts take the sea
/// in.
std::shared_ptr<const StaticLodTerrain> withOpenSea(std::shared_ptr<const StaticLodTerrain> trees,
                                                    std::span<const SceneryMesh> tiles,
                                                    const HeightSource& heights);

}  // namespace trimtab::terrain
