#pragma once

#include <cstddef>
#include <vector>

#include "trimtab/terrain/mesh/mesher.h"

namespace trimtab::bench {

/// Triangles of a mesh that nothing but its error binds: greedy insertion, over a whole field at once, of the
/// post that is most times further off than it may be, until none is. `allowedM` one a post, in order.
std::size_t unconstrainedTriangles(const terrain::HeightField& field, const std::vector<float>& allowedM);

}  // namespace trimtab::bench
