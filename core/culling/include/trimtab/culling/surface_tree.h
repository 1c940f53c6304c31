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

/// What may be drawn in the place of what: an index's levels, seen alike for tiles and patches. Refers to the
/// index.
struct SurfaceTree {
  static constexpr std::uint32_t kNone = TerrainIndex::kNone;
  static_assert(TerrainIndex::kNone == PatchIndex::kNone);

  std::span<const Box> bounds;
  std::span<const std::uint32_t> parent;
  const std::uint32_t* children = nullptr;  ///< childrenEach a node, kNone where there is none
  std::size_t childrenEach = 0;
  const float* errorM = nullptr;  ///< variants a node, rising: vertical distance to the source, metres
  /// The same over all of the source's surface, between its posts too, so that two surfaces are nowhere
  /// further apart than the sum of theirs: what is drawn is chosen by the posts alone. Null, not a number:
  /// not known.
  const float* surfaceErrorM = nullptr;
  std::size_t variants = 1;
  /// W, E, S, N of the same level; empty: not known. With them, neighbours differ by at most one level.
  std::span<const std::array<std::uint32_t, 4>> neighbours;

  static SurfaceTree of(const TerrainIndex& index);
  /// `surfaceErrorM`: of every patch, or of none.
  static SurfaceTree of(const PatchIndex& index, const VariantTable<float>& surfaceErrorM);

  std::size_t size() const { return bounds.size(); }
  std::span<const std::uint32_t> childrenOf(std::uint32_t node) const {
    return {children + node * childrenEach, childrenEach};
  }
  float finestError(std::uint32_t node) const { return errorM[node * variants]; }
  std::size_t variantOf(TileDraw tile) const { return variants > 1 ? tile.variant.number : 0; }
  float errorOf(TileDraw tile) const { return errorM[tile.node * variants + variantOf(tile)]; }
  /// Infinite where it is not known.
  float surfaceError(std::uint32_t node, std::size_t variant) const {
    const float error = surfaceErrorM ? surfaceErrorM[node * variants + variant] : NAN;
    return std::isfinite(error) ? error : std::numeric_limits<float>::infinity();
  }
};

}  // namespace trimtab
