#include <algorithm>
#include <bit>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/visible_walk.h"

namespace trimtab {
namespace {

constexpr int kCells = TerrainIndex::kTileCells;

void count(VisibleSet& visible, const TileDraw& tile, int sign) {
  // Each border that uses the coarser posts leaves out 16 vertices and folds 16 triangles away.
  const int sides = std::popcount(tile.coarser);
  visible.triangles += static_cast<std::uint64_t>(sign * (2 * kCells * kCells - sides * kCells / 2));
  visible.vertices += static_cast<std::uint64_t>(sign * ((kCells + 1) * (kCells + 1) - sides * kCells / 2));
}

}  // namespace

void gatherBoxes(std::span<const Box> bounds, LevelCut& cut) {
  cut.boxes.clear();
  cut.boxes.resize(cut.tiles.size());
  for (std::size_t i = 0; i < cut.tiles.size(); ++i) cut.boxes.set(i, bounds[cut.tiles[i].node]);
}

void walkCut(std::size_t nodes, const LevelCut& cut, const EyePose& eye, const ViewShape& view, bool test,
             double farM, std::span<const std::uint8_t> hidden, VisibleSet& visible) {
  visible.tiles.clear();
  visible.reason.assign(nodes, CullReason::other_level);
  visible.outsideFrustum = visible.occluded = visible.beyondVisibility = 0;

  const Frustum frustum(eye, view);
  const BlockTest mayShow(cut.boxes, frustum);
  const bool cutByDistance = test && farM < std::numeric_limits<double>::infinity();
  for (std::size_t block = 0; block * BoxArrays::kBlock < cut.tiles.size(); ++block) {
    const std::uint64_t shown = test ? mayShow(block) : ~std::uint64_t{0};
    const std::size_t first = block * BoxArrays::kBlock,
                      end = std::min(first + BoxArrays::kBlock, cut.tiles.size());
    for (std::size_t i = first; i < end; ++i) {
      const TileDraw tile = cut.tiles[i];
      CullReason reason = CullReason::drawn;
      if ((shown >> (i - first) & 1) == 0) {
        reason = CullReason::outside_frustum;
        ++visible.outsideFrustum;
      } else if (cutByDistance && isBeyond(cut.boxes[i], eye.position, farM)) {
        reason = CullReason::beyond_visibility;
        ++visible.beyondVisibility;
      } else if (!hidden.empty() && hidden[i] != 0) {
        reason = CullReason::occluded;
        ++visible.occluded;
      } else {
        visible.tiles.push_back(tile);
      }
      visible.reason[tile.node] = reason;
    }
  }
}

void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible, double farM, std::span<const std::uint8_t> hidden) {
  walkCut(index.size(), cut, eye, view, test, farM, hidden, visible);
  std::size_t sides = 0;
  for (const TileDraw& tile : visible.tiles) sides += static_cast<std::size_t>(std::popcount(tile.coarser));
  const std::size_t tiles = visible.tiles.size();
  visible.triangles = tiles * 2 * kCells * kCells - sides * kCells / 2;
  visible.vertices = tiles * (kCells + 1) * (kCells + 1) - sides * kCells / 2;
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
