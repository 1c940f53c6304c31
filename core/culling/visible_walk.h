#pragma once

#include <cstdint>
#include <span>

#include "trimtab/culling/select.h"

namespace trimtab {

/// What selectVisible does, whatever the nodes are: `nodes` of them are in the index. Triangles and vertices
/// are the caller's to count.
void walkCut(std::size_t nodes, const LevelCut& cut, const EyePose& eye, const ViewShape& view, bool test,
             double farM, std::span<const std::uint8_t> hidden, VisibleSet& visible);

}  // namespace trimtab
