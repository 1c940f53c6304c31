#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "trimtab/culling/select.h"
#include "trimtab/frame/patch_index.h"
#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// Says which surfaces may replace which. It describes the levels of an index of tiles or of patches. It
/// refers to the index, and for patches to `surfaceErrorM` as well, so both must outlive it unchanged. No
/// function checks the number of a node.
struct SurfaceTree {
  static constexpr std::uint32_t kNone = TerrainIndex::kNone;
  static_assert(TerrainIndex::kNone == PatchIndex::kNone);

  std::span<const Box> bounds;              ///< one per node
  std::span<const std::uint32_t> parent;    ///< one per node, kNone at the roots
  const std::uint32_t* children = nullptr;  ///< childrenEach per node, kNone if missing
  std::size_t childrenEach = 0;
  const float* errorM = nullptr;  ///< `variants` per node, rising: vertical error at the posts, metres
  /// `variants` per node: the vertical error over the whole of the source's surface, between its posts too,
  /// metres. The pointer is null, or a value is not finite, if that is not known. Two surfaces of the
  /// same ground are nowhere further apart than the sum of theirs. errorM, by which the LOD is chosen, does
  /// not promise that.
  const float* surfaceErrorM = nullptr;
  std::size_t variants = 1;
  /// One entry per node: its west, east, south and north neighbours at the same level, kNone at the border.
  /// The span is empty if they are not known. If they are, neighbours in a cut differ by one level at most.
  std::span<const std::array<std::uint32_t, 4>> neighbours;

  /// Returns the tree of tiles. Its surfaceErrorM is its errorM, because two surfaces of tiles are furthest
  /// apart at posts.
  static SurfaceTree of(const TerrainIndex& index);
  /// Returns the tree of patches, without neighbours. `surfaceErrorM` counts as not known unless it has as
  /// many patches and variants as the index.
  static SurfaceTree of(const PatchIndex& index, const VariantTable<float>& surfaceErrorM);

  std::size_t size() const { return bounds.size(); }
  /// Returns childrenEach numbers, kNone among them.
  std::span<const std::uint32_t> childrenOf(std::uint32_t node) const {
    return {children + node * childrenEach, childrenEach};
  }
  /// These return errorM of the finest variant, the number of the variant that is drawn, and its errorM.
  float finestError(std::uint32_t node) const { return errorM[node * variants]; }
  std::size_t variantOf(TileDraw tile) const { return variants > 1 ? tile.variant.number : 0; }
  float errorOf(TileDraw tile) const { return errorM[tile.node * variants + variantOf(tile)]; }
  /// Returns surfaceErrorM of a variant, or infinity if it is not known.
  float surfaceError(std::uint32_t node, std::size_t variant) const {
    const float error = surfaceErrorM ? surfaceErrorM[node * variants + variant] : NAN;
    return std::isfinite(error) ? error : std::numeric_limits<float>::infinity();
  }
};

}  // namespace trimtab
