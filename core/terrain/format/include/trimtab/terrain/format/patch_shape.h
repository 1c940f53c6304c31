#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/terrain/grid/post_place.h"

/// Computes where patches lie, in posts, with integers only.
namespace trimtab::terrain {

using PatchPoint = PostPlace;

/// The place of a patch: part 0 and 1 are the halves of a square, 2 to 5 its quarters S, E, N, W.
struct PatchPlace {
  int pair = 0;
  std::uint32_t column = 0, row = 0;  ///< of its square, in squares of its pair
  int part = 0;
  int depth() const { return 2 * pair + (part < 2 ? 0 : 1); }
  friend bool operator==(const PatchPlace&, const PatchPlace&) = default;
};

constexpr int kPatchParts = 6;

/// Reports whether the diagonal of a square runs from south-west to north-east. Every other one does, so that
/// it points to the middle of the larger square.
inline bool southWestDiagonal(std::uint32_t column, std::uint32_t row) {
  return (column + row) % 2 == 0;
}

/// An edge of a patch: part of its hypotenuse or of a leg, or along the border of the posts.
struct PatchEdge {
  PatchPoint from, to;
  int side = 0;  ///< the depth of the patches whose hypotenuse it is, or kDataEdge
  static constexpr int kDataEdge = -1;
};

/// Returns the edges of a patch anticlockwise, cut off at the last post: a convex polygon with posts as
/// corners. It is empty if the patch lies outside the posts.
std::vector<PatchEdge> patchEdges(const PatchIndex& index, const PatchPlace& place);

/// Returns the parent: of a half the quarter that it came from (its pair must be above 0), of a quarter its
/// half.
PatchPlace parentOf(const PatchPlace& place);
/// Sets `other` to the patch that shares the hypotenuse. Returns false if that is outside the grid of
/// squares.
bool acrossHypotenuse(const PatchIndex& index, const PatchPlace& place, PatchPlace& other);

/// Returns how many squares of a pair lie along a side of so many posts.
std::uint32_t squaresAlong(const PatchIndex& index, int pair, std::uint32_t posts);
int pairs(const PatchIndex& index);

/// Returns the patches of a page, in order.
std::vector<PatchPlace> placesOfPage(const PatchIndex& index, const PatchIndex::Page& page);

}  // namespace trimtab::terrain
