#include <algorithm>
#include <bit>
#include <cstring>

#include "trimtab/culling/back_facing.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/select.h"

namespace trimtab {
namespace {

constexpr std::size_t kBlock = BoxArrays::kBlock;
constexpr std::uint64_t kAll = ~std::uint64_t{0};

std::uint64_t firstBits(std::size_t count) {
  return count < 64 ? (std::uint64_t{1} << count) - 1 : kAll;
}

template <class Visit>
void forEachBit(std::uint64_t bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Returns a bit for each byte, set if the byte is not 0.
std::uint64_t bitsOf(const std::uint8_t* bytes, std::size_t count) {
  std::uint64_t bits = 0;
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes + i, 8);
    if (eight == 0) continue;
    for (std::size_t k = i; k < i + 8; ++k) bits |= std::uint64_t{bytes[k] != 0} << k;
  }
  for (; i < count; ++i) bits |= std::uint64_t{bytes[i] != 0} << i;
  return bits;
}

class Walk {
 public:
  Walk(const LevelCut& cut, const VisibleQuery& query, VisibleSet& visible)
      : cut_(cut),
        eye_(query.eye.position),
        farM_(query.cull ? query.farM : std::numeric_limits<double>::infinity()),
        reach_(std::max(farM_, 0.0)),
        hidden_(query.hidden.size() >= cut.tiles.size() ? query.hidden : std::span<const std::uint8_t>{}),
        backFaces_(query.cull && query.backFaces && cut.cones.size() == cut.tiles.size()),
        visible_(visible) {}

  /// Adds a block's tiles. `shown` has a bit for each tile in the frustum.
  void block(std::size_t block, std::uint64_t shown) {
    const std::size_t first = block * kBlock, count = std::min(kBlock, cut_.tiles.size() - first);
    const std::uint64_t whole = firstBits(count);
    visible_.outsideFrustum -= static_cast<std::size_t>(std::popcount(shown));
    if (farM_ < std::numeric_limits<double>::infinity())
      take(CullReason::beyond_visibility, visible_.beyondVisibility, first, shown, beyond(block, shown));
    if (!hidden_.empty() && shown != 0)
      take(CullReason::occluded, visible_.occluded, first, shown, bitsOf(hidden_.data() + first, count));
    if (backFaces_ && shown != 0 && mayFaceAway(cut_.blockSteepness[block], cut_.blockBoxes[block], eye_))
      take(CullReason::back_facing, visible_.backFacing, first, shown, facingAway(first, shown));
    if (shown == 0) return;
    mark(first, shown, CullReason::drawn);
    if (shown == whole) {
      visible_.triangles += cut_.blockTriangles[block];
      if (runEnd_ != first) flush(), run_ = first;
      runEnd_ = first + count;
      return;
    }
    flush();
    forEachBit(shown, [&](std::size_t i) { visible_.triangles += cut_.triangles[first + i]; });
    while (shown != 0) {
      const auto from = static_cast<unsigned>(std::countr_zero(shown)),
                 length = static_cast<unsigned>(std::countr_one(shown >> from));
      append(first + from, first + from + length);
      shown &= ~(firstBits(length) << from);
    }
  }

  /// Copies the pending run of whole blocks at once.
  void flush() {
    append(run_, runEnd_);
    run_ = runEnd_ = 0;
  }

 private:
  void append(std::size_t from, std::size_t to) {
    const auto begin = cut_.tiles.begin();
    visible_.tiles.insert(visible_.tiles.end(), begin + static_cast<std::ptrdiff_t>(from),
                          begin + static_cast<std::ptrdiff_t>(to));
  }

  void mark(std::size_t first, std::uint64_t bits, CullReason reason) {
    CullReason* places = visible_.reason.data() + first;
    if (bits == kAll)
      std::fill_n(places, kBlock, reason);
    else
      forEachBit(bits, [&](std::size_t i) { places[i] = reason; });
  }

  void take(CullReason reason, std::size_t& counter, std::size_t first, std::uint64_t& shown,
            std::uint64_t out) {
    out &= shown;
    if (out == 0) return;
    shown &= ~out;
    counter += static_cast<std::size_t>(std::popcount(out));
    mark(first, out, reason);
  }

  std::uint64_t beyond(std::size_t block, std::uint64_t shown) const {
    const Box all = cut_.blockBoxes[block];
    if (isBeyond(all, eye_, farM_)) return kAll;
    const auto furthest = [](double low, double high, double at) {
      const double away = std::max(std::abs(low - at), std::abs(high - at));
      return away * away;
    };
    if (furthest(all.minX, all.maxX, eye_.x) + furthest(all.minY, all.maxY, eye_.y) +
            furthest(all.minZ, all.maxZ, eye_.z) <=
        reach_ * reach_)
      return 0;
    std::uint64_t out = 0;
    forEachBit(shown, [&](std::size_t i) {
      out |= std::uint64_t{isBeyond(cut_.boxes[block * kBlock + i], eye_, farM_)} << i;
    });
    return out;
  }

  std::uint64_t facingAway(std::size_t first, std::uint64_t shown) const {
    std::uint64_t out = 0;
    forEachBit(shown, [&](std::size_t i) {
      out |= std::uint64_t{facesAway(cut_.cones[first + i], cut_.boxes[first + i], eye_)} << i;
    });
    return out;
  }

  const LevelCut& cut_;
  Vec3 eye_;
  double farM_, reach_;
  std::span<const std::uint8_t> hidden_;
  bool backFaces_;
  VisibleSet& visible_;
  std::size_t run_ = 0, runEnd_ = 0;  ///< the run to be copied
};

void clear(const LevelCut& cut, VisibleSet& visible) {
  visible.tiles.clear();
  visible.tiles.reserve(cut.tiles.size());
  visible.nodes = cut.nodes;
  visible.outsideFrustum = visible.occluded = visible.beyondVisibility = visible.backFacing = 0;
  visible.triangles = visible.vertices = 0;
}

}  // namespace

void selectVisible(const LevelCut& cut, const VisibleQuery& query, VisibleSet& visible) {
  clear(cut, visible);
  visible.outsideFrustum = cut.tiles.size();
  visible.reason.assign(cut.tiles.size(), CullReason::outside_frustum);
  Walk walk(cut, query, visible);
  const Frustum frustum(query.eye, query.view);
  // The blocks' boxes are tested first, because most blocks are wholly outside or inside.
  const BlockTest ofBlocks(cut.blockBoxes, frustum), ofTiles(cut.boxes, frustum);
  for (std::size_t group = 0; group < ofBlocks.blocks(); ++group) {
    const std::size_t first = group * kBlock, count = std::min(kBlock, cut.blockBoxes.size() - first);
    const std::uint64_t some = query.cull ? ofBlocks(group) : firstBits(count),
                        all = query.cull ? ofBlocks.wholly(group) : some;
    forEachBit(some, [&](std::size_t i) {
      const bool inside = (all >> i & 1) != 0;
      const std::size_t tiles = std::min(kBlock, cut.tiles.size() - (first + i) * kBlock);
      walk.block(first + i, inside ? firstBits(tiles) : ofTiles(first + i));
    });
  }
  walk.flush();
}

void removeOccluded(const LevelCut& cut, std::span<const std::uint8_t> flags, VisibleSet& visible) {
  std::size_t kept = 0, place = 0;
  for (std::size_t i = 0; i < visible.tiles.size(); ++i, ++place) {
    while (visible.reason[place] != CullReason::drawn) ++place;
    if (i >= flags.size() || flags[i] == 0) {
      visible.tiles[kept++] = visible.tiles[i];
      continue;
    }
    const bool hidden = flags[i] == 1;
    visible.reason[place] = hidden ? CullReason::occluded : CullReason::outside_frustum;
    ++(hidden ? visible.occluded : visible.outsideFrustum);
    visible.triangles -= cut.triangles[place];
  }
  visible.tiles.resize(kept);
}

std::uint64_t tileVertices(const VisibleSet& visible) {
  // A border stitched to a coarser neighbour leaves out as many vertices as triangles.
  constexpr std::uint64_t kCells = TerrainIndex::kTileCells;
  return visible.triangles + visible.tiles.size() * ((kCells + 1) * (kCells + 1) - 2 * kCells * kCells);
}

}  // namespace trimtab
