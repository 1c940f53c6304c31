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
  return 2 * kCells * kCells - static_cast<std::uint32_t>(std::popcount(tile.border.bits)) * kCells / 2;
}

/// Makes the rest of a cut from its tiles and `cut.triangles`. `cones`: the index's, or empty.
void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut);

/// Takes the nodes out of `visible` that `flags` tell of, one each in order: 1 is hidden, anything else but 0
/// outside the frustum; those past the flags stay. `leftOut(place in the cut, node)` counts.
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
