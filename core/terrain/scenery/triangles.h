#pragma once

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

/// Drops triangles with two vertices at one place, and turns the whole mesh over if most of it faces down.
/// Single slivers that face down stay as they are, because turning them would break the order of their
/// neighbours' edges.
void tidyTriangles(SceneryMesh& mesh);

}  // namespace trimtab::terrain
