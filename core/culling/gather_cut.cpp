#include <algorithm>
#include <bit>
#include <limits>

#include "gather_cut.h"
#include "trimtab/culling/back_facing.h"
#include "trimtab/frame/box_union.h"

namespace trimtab {
namespace {

constexpr std::size_t kBlock = BoxArrays::kBlock;

/// Returns the triangles of a tile. Each border that is stitched to a coarser neighbour saves 16 of them.
std::uint32_t tileTriangles(TileDraw tile) {
  constexpr std::uint32_t kCells = TerrainIndex::kTileCells;
  return 2 * kCells * kCells - static_cast<std::uint32_t>(std::popcount(tile.border.bits)) * kCells / 2;
}

/// The union of boxes. It is not a number if one of them is not finite, so that no test concludes anything
/// from it.
class BoxUnion {
 public:
  void add(const Box& b) {
    all_ = united(all_, b);
    // This is 0 for finite numbers and not a number otherwise; min and max would skip what is not a number.
    zero_ += 0 * (b.minX + b.minY + b.minZ) + 0 * (b.maxX + b.maxY + b.maxZ);
  }
  Box box() const {
    if (zero_ == 0) return all_;
    constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
    return {kNanF, kNanF, kNanF, kNanF, kNanF, kNanF};
  }

 private:
  Box all_ = kNoBox;
  float zero_ = 0;
};

}  // namespace

void gatherCut(std::span<const Box> bounds, std::span<const NormalCone> cones, LevelCut& cut) {
  const std::size_t count = cut.tiles.size();
  // Visible sets of earlier cuts may hold the last list.
  if (cut.nodes.use_count() != 1) cut.nodes = std::make_shared<std::vector<std::uint32_t>>();
  std::vector<std::uint32_t>& nodes = *cut.nodes;
  nodes.resize(count);
  cut.boxes.clear();
  cut.boxes.resize(count);
  cut.blockBoxes.clear();
  cut.blockBoxes.resize(cut.boxes.blocks());
  cut.blockTriangles.assign(cut.boxes.blocks(), 0);
  cut.cones.resize(cones.empty() ? 0 : count);
  cut.blockSteepness.assign(cones.empty() ? 0 : cut.boxes.blocks(), std::numeric_limits<std::int16_t>::min());
  for (std::size_t block = 0; block < cut.boxes.blocks(); ++block) {
    const std::size_t first = block * kBlock, end = std::min(first + kBlock, count);
    BoxUnion all;
    for (std::size_t i = first; i < end; ++i) {
      const std::uint32_t node = cut.tiles[i].node;
      nodes[i] = node;
      cut.boxes.set(i, bounds[node]);
      all.add(bounds[node]);
      cut.blockTriangles[block] += cut.triangles[i];
    }
    cut.blockBoxes.set(block, all.box());
    if (cones.empty()) continue;
    for (std::size_t i = first; i < end; ++i) {
      cut.cones[i] = cones[cut.tiles[i].node];
      cut.blockSteepness[block] = std::max(cut.blockSteepness[block], steepness(cut.cones[i]));
    }
  }
}

void gather(const TerrainIndex& index, LevelCut& cut) {
  cut.triangles.clear();
  for (const TileDraw& tile : cut.tiles) cut.triangles.push_back(tileTriangles(tile));
  gatherCut(index.bounds, index.cones, cut);
}

}  // namespace trimtab
