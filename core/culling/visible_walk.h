#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "trimtab/culling/select.h"

namespace trimtab {

/// Does what selectVisible does for nodes of any kind, but does not count vertices.
void walkCut(const LevelCut& cut, const EyePose& eye, const ViewShape& view, bool test, double farM,
             std::span<const std::uint8_t> hidden, bool backFaces, VisibleSet& visible);

/// Returns the triangles of a tile. Each border that is stitched to a coarser neighbour saves 16 of them.
inline std::uint32_t tileTriangles(TileDraw tile) {
  constexpr std::uint32_t kCells = TerrainIndex::kTileCells;
  return 2 * kCells * kCells - static_cast<std::uint32_t>(std::popcount(tile.coarser)) * kCells / 2;
}

/// Computes the rest of a cut from its tiles and `cut.triangles`. `cones` are the index's, or empty.
void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut);

/// Removes nodes from `visible` by one flag each, in order: 0 keeps the node, 1 says that it is hidden, any
/// other value that it is outside the frustum. Nodes beyond the flags stay. Calls leftOut(place in the cut,
/// node) for each that is removed.
template <class LeftOut>
void removeFlagged(std::span<const std::uint8_t> flags, VisibleSet& visible, const LeftOut& leftOut) {
  std::size_t kept = 0, place = 0;
  for (std::size_t i = 0; i < visible.tiles.size(); ++i, ++place) {
    const TileDraw tile = visible.tiles[i];
    while (visible.reason[place] != CullReason::drawn) ++place;
    if (i >= flags.size() || flags[i] == 0) {
      visible.tiles[kept++] = tile;
      continue;
    }
    const bool hidden = flags[i] == 1;
    visible.reason[place] = hidden ? CullReason::occluded : CullReason::outside_frustum;
    ++(hidden ? visible.occluded : visible.outsideFrustum);
    leftOut(place, tile);
  }
  visible.tiles.resize(kept);
}

}  // namespace trimtab
