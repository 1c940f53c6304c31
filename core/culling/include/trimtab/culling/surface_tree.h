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

/// Which surfaces may replace which: the levels of an index in one form for tiles and for patches. It refers
/// to the index, which must outlive it.
struct SurfaceTree {
  static constexpr std::uint32_t kNone = TerrainIndex::kNone;
  static_assert(TerrainIndex::kNone == PatchIndex::kNone);

  std::span<const Box> bounds;
  std::span<const std::uint32_t> parent;
  const std::uint32_t* children = nullptr;  ///< childrenEach per node, kNone if missing
  std::size_t childrenEach = 0;
  const float* errorM = nullptr;  ///< `variants` per node, rising: vertical error at the posts, metres
  /// The same over the whole of the source's surface, between its posts too. Two surfaces are nowhere further
  /// apart than the sum of these; errorM, by which the LOD is chosen, does not promise that. Null or not a
  /// number if it is not known.
  const float* surfaceErrorM = nullptr;
  std::size_t variants = 1;
  /// West, east, south and north neighbours at the same level; empty if not known. If they are known,
  /// neighbours in a cut differ by one level at most.
  std::span<const std::array<std::uint32_t, 4>> neighbours;

  static SurfaceTree of(const TerrainIndex& index);
  /// `surfaceErrorM` must have the size of the index, or it counts as not known.
  static SurfaceTree of(const PatchIndex& index, const VariantTable<float>& surfaceErrorM);

  std::size_t size() const { return bounds.size(); }
  std::span<const std::uint32_t> childrenOf(std::uint32_t node) const {
    return {children + node * childrenEach, childrenEach};
  }
  float finestError(std::uint32_t node) const { return errorM[node * variants]; }
  std::size_t variantOf(TileDraw tile) const { return variants > 1 ? tile.coarser : 0; }
  float errorOf(TileDraw tile) const { return errorM[tile.node * variants + variantOf(tile)]; }
  /// Returns infinity if the error is not known.
  float surfaceError(std::uint32_t node, std::size_t variant) const {
    const float error = surfaceErrorM ? surfaceErrorM[node * variants + variant] : NAN;
    return std::isfinite(error) ? error : std::numeric_limits<float>::infinity();
  }
};

}  // namespace trimtab
