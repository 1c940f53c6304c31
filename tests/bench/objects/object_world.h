#pragma once

#include <memory>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/object_terrain.h"

namespace trimtab::bench {

/// Returns trees, houses and masts of twelve models, with the levels that a bake makes of them, at random
/// places on dry ground within `radiusKm` of the middle of a terrain; null if they cannot be made.
std::shared_ptr<const terrain::ObjectTerrain> scatteredOver(const terrain::Database& ground, int count,
                                                            double radiusKm);

/// Returns the trees of these at random places on the forest of a scenery's static LOD trees, as even in area
/// as its triangles allow, within `radiusKm` of the middle; null if they cannot be made.
std::shared_ptr<const terrain::ObjectTerrain> treesOnForest(const terrain::Database& ground, int count,
                                                            double radiusKm);

}  // namespace trimtab::bench
