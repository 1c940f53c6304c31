#include <bit>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/select.h"

namespace trimtab {
namespace {

void count(VisibleSet& visible, const TileDraw& tile, int sign) {
  // Each border that uses the coarser posts leaves out 16 vertices and folds 16 triangles away.
  const int sides = std::popcount(tile.coarser);
  constexpr int kCells = TerrainIndex::kTileCells;
  visible.triangles += static_cast<std::uint64_t>(sign * (2 * kCells * kCells - sides * kCells / 2));
  visible.vertices += static_cast<std::uint64_t>(sign * ((kCells + 1) * (kCells + 1) - sides * kCells / 2));
}

}  // namespace

void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible, double farM) {
  visible.tiles.clear();
  visible.reason.assign(index.size(), CullReason::other_level);
  visible.outsideFrustum = visible.occluded = visible.beyondVisibility = 0;
  visible.triangles = visible.vertices = 0;

  const Frustum frustum(eye, view);
  for (const TileDraw& tile : cut.tiles) {
    const Box& box = index.bounds[tile.node];
    if (test && !frustum.mayShow(box)) {
      visible.reason[tile.node] = CullReason::outside_frustum;
      ++visible.outsideFrustum;
    } else if (test && isBeyond(box, eye.position, farM)) {
      visible.reason[tile.node] = CullReason::beyond_visibility;
      ++visible.beyondVisibility;
    } else {
      visible.tiles.push_back(tile);
      visible.reason[tile.node] = CullReason::drawn;
      count(visible, tile, 1);
    }
  }
}

void removeOccluded(const TerrainIndex&, std::span<const std::uint8_t> flags, VisibleSet& visible) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < visible.tiles.size(); ++i) {
    const TileDraw tile = visible.tiles[i];
    if (i >= flags.size() || flags[i] == 0) {
      visible.tiles[kept++] = tile;
      continue;
    }
    const bool hidden = flags[i] == 1;
    visible.reason[tile.node] = hidden ? CullReason::occluded : CullReason::outside_frustum;
    ++(hidden ? visible.occluded : visible.outsideFrustum);
    count(visible, tile, -1);
  }
  visible.tiles.resize(kept);
}

}  // namespace trimtab
