#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// Returns coarser meshes of a checked one, of about half, a quarter and so on of its triangles, some in two
/// ways, each made from `mesh` itself. How far they are from it is not known. `textures`: the mean colours of
/// its textures.
std::vector<SourceMesh> simplified(const SourceMesh& mesh,
                                   const std::vector<std::array<std::uint8_t, 4>>& textures);

}  // namespace trimtab::terrain
