#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "trimtab/culling/select.h"

namespace trimtab {

/// What selectVisible does, whatever the nodes are. Vertices are the caller's to count.
void walkCut(const LevelCut& cut, const EyePose& eye, const ViewShape& view, bool test, double farM,
             std::span<const std::uint8_t> hidden, bool backFaces, VisibleSet& visible);

/// Each border that uses the coarser posts folds 16 triangles away.
inline std::uint32_t tileTriangles(TileDraw tile) {
  constexpr std::uint32_t kCells = TerrainIndex::kTileCells;
  return 2 * kCells * kCells - static_cast<std::uint32_t>(std::popcount(tile.coarser)) * kCells / 2;
}

/// Makes the rest of a cut from its tiles and `cut.triangles`. `cones`: the index's, or empty.
void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut);

}  // namespace trimtab
