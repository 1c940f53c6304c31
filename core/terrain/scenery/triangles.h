#pragma once

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

/// Drops triangles two of whose vertices are one place under two numbers, and turns the whole mesh where most
/// of it faces down. Single slivers that face down stay: turned, they would break the order of their
/// neighbours' edges.
void tidyTriangles(SceneryMesh& mesh);

}  // namespace trimtab::terrain
