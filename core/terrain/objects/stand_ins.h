#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// Returns meshes of two to twelve triangles over the bounds of a mesh, in one colour: a box with and without
/// its bottom, a pyramid, two pyramids base to base, two crossed cards, and two crossed triangles. Which of
/// them is near the mesh is for others to measure. Empty for a mesh without height or breadth.
std::vector<SourceMesh> standIns(const SourceMesh& mesh, const std::array<std::uint8_t, 4>& colour);

}  // namespace trimtab::terrain
