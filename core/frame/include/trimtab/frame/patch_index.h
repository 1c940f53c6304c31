#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/frame/variant_table.h"

namespace trimtab {

/// The patches of a terrain as flat arrays, without their meshes.
///
/// Posts are columns x rows, counted from the south-west. Root squares of `rootCells` cells (a power of two)
/// cover them from post (0, 0); what reaches past the posts is cut off. A square of side s = rootCells >> i,
/// down to leafCells, is two patches of depth 2i, right triangles on its south-west or south-east diagonal,
/// and four patches of depth 2i + 1, its quarters around the centre. So each patch is halved from the middle
/// of its hypotenuse: a binary tree of right triangles.
///
/// Why this scheme: a *diamond* is the two patches of one depth that share a hypotenuse (one patch where the
/// posts end). Diamonds are halved as a whole, and only after the diamonds that their patches came from. Then
/// two neighbours in any cut share a whole side, because a leg of one depth is a hypotenuse of the next. Each
/// side has one polyline, simplified once, which the patches on both sides use. So there are no cracks in any
/// mixture, without skirts or stitching. Inside its three polylines a patch has two or three meshes of rising
/// error (its variants), and any of them fits. Measured: 1.2 times the triangles of an unconstrained mesh,
/// where meshes of single right triangles and quadtrees of one level's difference have 1.8 (1.28 with patches
/// of twice the side, 1.24 with three meshes: granularity costs more than borders do).
struct PatchIndex {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kLeafPageCells = 128;  ///< side of a page of the smallest squares
  static constexpr std::size_t kMostVariants = 3;

  /// Two patches that share a hypotenuse. It may be halved only after the diamonds whose children its patches
  /// are.
  struct Diamond {
    std::array<std::uint32_t, 2> patches{kNone, kNone};  ///< the second is kNone where the posts end
    std::array<std::uint32_t, 2> parents{kNone, kNone};  ///< one per patch; kNone at the roots
  };
  /// The unit of reading from disk: patches of both depths of some squares of one size.
  struct Page {
    std::uint32_t firstPatch = 0, patches = 0;
    std::uint8_t pair = 0;              ///< i: patches of depths 2i and 2i + 1
    std::uint32_t row = 0, column = 0;  ///< in blocks of pageSquares() squares of that side
  };

  LocalFrame frame;
  std::uint32_t columns = 0, rows = 0;  ///< posts
  std::uint32_t rootCells = 0;
  std::uint32_t leafCells = 1;  ///< side of the smallest squares, a power of two

  // One entry per patch. Pages follow each other from the coarsest, so parents come before their children.
  std::vector<Box> bounds;  ///< of everything this patch or any descendant may draw, local frame
  /// Cones of the normals of all triangles that a patch itself draws, in any variant; empty if they are
  /// unknown.
  std::vector<NormalCone> cones;
  /// The worst vertical error at the source posts, metres, per variant from the finest. It rises with the
  /// variant and up the tree, and includes the earth's curvature and the rounding of vertices.
  VariantTable<float> errorM;
  VariantTable<std::uint16_t> triangles;
  std::vector<std::uint8_t> depth;
  std::vector<std::uint32_t> parent;                   ///< kNone at the roots
  std::vector<std::array<std::uint32_t, 2>> children;  ///< kNone if there is none
  std::vector<std::uint32_t> diamond;                  ///< the diamond that it is half of
  std::vector<std::uint32_t> page;

  std::vector<Diamond> diamonds;  ///< parents before children
  std::vector<Page> pages;

  std::size_t size() const { return bounds.size(); }
  /// Returns how many meshes each patch has, at most kMostVariants.
  std::size_t variants() const { return errorM.variants(); }
  std::uint32_t squareCells(int pair) const { return rootCells >> pair; }
  /// Returns how many squares a page has along each side.
  std::uint32_t pageSquares() const { return kLeafPageCells / leafCells; }
};

}  // namespace trimtab
