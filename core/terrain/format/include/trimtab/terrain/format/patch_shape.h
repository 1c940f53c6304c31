#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/terrain/grid/post_place.h"

/// Where patches lie, in posts: integers throughout.
namespace trimtab::terrain {

using PatchPoint = PostPlace;

/// A patch by its place: 0 and 1 are the halves of a square, 2 to 5 its quarters S, E, N, W.
struct PatchPlace {
  int pair = 0;
  std::uint32_t column = 0, row = 0;  ///< square of its pair
  int part = 0;
  int depth() const { return 2 * pair + (part < 2 ? 0 : 1); }
  friend bool operator==(const PatchPlace&, const PatchPlace&) = default;
};

constexpr int kPatchParts = 6;

/// Its diagonal runs from south-west to north-east: every other one, so that it points to the middle of the
/// square that it is a quarter of.
inline bool southWestDiagonal(std::uint32_t column, std::uint32_t row) {
  return (column + row) % 2 == 0;
}

/// An edge of a patch: a part of its hypotenuse or of a leg, or where the posts end.
struct PatchEdge {
  PatchPoint from, to;
  int side = 0;  ///< depth of the patches whose hypotenuse it is; kDataEdge
  static constexpr int kDataEdge = -1;
};

/// Its edges, anticlockwise, cut off at the last post: convex, corners are posts. Empty: wholly outside.
std::vector<PatchEdge> patchEdges(const PatchIndex& index, const PatchPlace& place);

/// Of a half: the quarter that it came from; pair > 0. Of a quarter: its half.
PatchPlace parentOf(const PatchPlace& place);
/// What shares its hypotenuse, if that is in the grid of squares.
bool acrossHypotenuse(const PatchIndex& index, const PatchPlace& place, PatchPlace& other);

/// Squares of a pair along a side.
std::uint32_t squaresAlong(const PatchIndex& index, int pair, std::uint32_t posts);
int pairs(const PatchIndex& index);

/// The patches of a page, in order.
std::vector<PatchPlace> placesOfPage(const PatchIndex& index, const PatchIndex::Page& page);

}  // namespace trimtab::terrain
