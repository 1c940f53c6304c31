#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"
#include "trimtab/frame/variant_table.h"

namespace trimtab {

/// The error-bounded levels of a terrain as flat arrays; meshes are not here.
///
/// Posts are columns x rows, from south-west. Root squares of `rootCells` cells (a power of two) cover them
/// from post (0, 0); what reaches past the posts is cut off. A square of side s is two patches of depth 2i,
/// right triangles on its south-west or south-east diagonal, and four of depth 2i + 1, its quarters about the
/// centre (s = rootCells >> i, down to leafCells). So a patch is halved from the middle of its hypotenuse,
/// again and again: a bintree of right triangles.
///
/// Why this scheme. A *diamond* is the two patches of one depth that share a hypotenuse (one, where the posts
/// end). If diamonds are halved as a whole only, and a diamond only after the patches that it halves are
/// there, then two neighbours in any cut share a whole side: a leg of one depth is a hypotenuse of the next.
/// Each side has one polyline, simplified once, that every patch at it uses: no cracks, at any mixture, with
/// no skirts and nothing to stitch. Inside its three polylines a patch has two meshes of rising error or
/// three (its variants), and any of them fits. Measured beside right-triangle meshes of single triangles and
/// quadtrees held to one level's difference: 1.2 times the triangles of an unconstrained mesh instead of 1.8
/// (with patches of twice the side 1.28, and 1.24 with three meshes: granularity costs more than borders do).
struct PatchIndex {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kLeafPageCells = 128;  ///< side of a page of the smallest squares
  static constexpr std::size_t kMostVariants = 3;

  /// Two patches about one hypotenuse. Halving it needs the two diamonds that it came from halved before:
  /// those whose children its patches are.
  struct Diamond {
    std::array<std::uint32_t, 2> patches{kNone, kNone};  ///< the second kNone where the posts end
    std::array<std::uint32_t, 2> parents{kNone, kNone};  ///< one a patch; kNone at the roots
  };
  /// What is read from disk at a time: patches of both depths of one size of square.
  struct Page {
    std::uint32_t firstPatch = 0, patches = 0;
    std::uint8_t pair = 0;              ///< i: patches of depths 2i and 2i + 1
    std::uint32_t row = 0, column = 0;  ///< in blocks of pageSquares() squares of that side
  };

  LocalFrame frame;
  std::uint32_t columns = 0, rows = 0;  ///< posts
  std::uint32_t rootCells = 0;
  std::uint32_t leafCells = 1;  ///< side of the smallest squares, a power of two

  // One entry a patch; pages follow each other from the coarsest, so parents stand before their children.
  std::vector<Box> bounds;  ///< of everything this patch or any descendant may draw, local frame
  /// Of every triangle that this patch draws itself, in any variant; empty where they are not known.
  std::vector<NormalCone> cones;
  /// Largest vertical distance at the source posts, metres, by variant from the finest: rises with the
  /// variant, and up the tree. Includes what the earth's curvature and the rounding of vertices add.
  VariantTable<float> errorM;
  VariantTable<std::uint16_t> triangles;
  std::vector<std::uint8_t> depth;
  std::vector<std::uint32_t> parent;                   ///< kNone at the roots
  std::vector<std::array<std::uint32_t, 2>> children;  ///< kNone where there is none
  std::vector<std::uint32_t> diamond;                  ///< that it is a half of
  std::vector<std::uint32_t> page;

  std::vector<Diamond> diamonds;  ///< parents before children
  std::vector<Page> pages;

  std::size_t size() const { return bounds.size(); }
  /// Meshes of each patch, at most kMostVariants.
  std::size_t variants() const { return errorM.variants(); }
  std::uint32_t squareCells(int pair) const { return rootCells >> pair; }
  /// A page holds the patches of so many squares, squared.
  std::uint32_t pageSquares() const { return kLeafPageCells / leafCells; }
};

}  // namespace trimtab
