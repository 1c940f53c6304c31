#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

/// Declares which nodes a frame draws, and for every node that it does not draw, why.
namespace trimtab {

enum class CullReason : std::uint8_t {
  drawn,
  outside_frustum,
  occluded,           ///< proven hidden by the horizon or the depth map
  beyond_visibility,  ///< in the frustum, but wholly beyond the weather's far distance
  back_facing,        ///< all of its triangles face away from the eye, so that nearer ones hide them
  other_level         ///< an ancestor or descendants are drawn instead
};

/// The sides of a tile whose neighbour is one LOD coarser, where the border uses the coarser posts: bits
/// W = 1, E = 2, S = 4, N = 8.
struct BorderMask {
  std::uint8_t bits = 0;
  constexpr BorderMask() = default;
  constexpr explicit BorderMask(unsigned sides) : bits(static_cast<std::uint8_t>(sides)) {}
  friend bool operator==(const BorderMask&, const BorderMask&) = default;
};

/// Says which of a patch's triangulations is drawn; 0 is the finest.
struct PatchVariant {
  std::uint8_t number = 0;
  constexpr PatchVariant() = default;
  constexpr explicit PatchVariant(std::size_t n) : number(static_cast<std::uint8_t>(n)) {}
  friend bool operator==(const PatchVariant&, const PatchVariant&) = default;
};

/// One node of a cut: a tile, a patch or a node of static trees.
struct TileDraw {
  std::uint32_t node = 0;
  BorderMask border = {};     ///< of a tile; empty for the other forms
  PatchVariant variant = {};  ///< of a patch; 0 for the other forms
  /// The drawer sets it: back faces are drawn too, although the image culls them.
  bool bothSides = false;
};

/// Holds what a view draws of a cut. Its size follows the cut and not the index: reasons are stored by place
/// in the cut.
struct VisibleSet {
  std::vector<TileDraw> tiles;     ///< to draw, in the cut's order
  std::vector<CullReason> reason;  ///< one per node of the cut, in order
  std::shared_ptr<const std::vector<std::uint32_t>>
      nodes;  ///< numbers of the cut's nodes, in order; may be null
  std::size_t outsideFrustum = 0, occluded = 0, beyondVisibility = 0,
              backFacing = 0;                 ///< tiles of the cut, by reason
  std::uint64_t triangles = 0, vertices = 0;  ///< of the tiles drawn; degenerate triangles not counted

  /// Returns the reason of a node; other_level if the node is not in the cut. It searches the whole cut.
  CullReason reasonOf(std::uint32_t node) const;
  /// Returns the reasons of all `ofNodes` nodes of an index.
  std::vector<CullReason> reasons(std::size_t ofNodes) const;
};

}  // namespace trimtab
