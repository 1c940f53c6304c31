#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// Divides a grid of posts into patches (trimtab/frame/patch_index.h says what patches are).
namespace trimtab::terrain {

/// The two possible sides of the smallest squares, in cells. With the finer one a view at 2 px over Everest
/// needs 1.34 times the triangles of an unconstrained mesh instead of 1.44, and the index is four times as
/// long.
inline constexpr std::uint32_t kFineLeafCells = 16, kCoarseLeafCells = 32;
/// A country of 13,000 x 11,000 posts has so many squares of the coarser side: 1.2 million patches.
inline constexpr std::uint64_t kMostFineSquares = 150'000;
/// Returns the finer side if the grid has no more than `mostFine` of its squares, else the coarser one.
std::uint32_t leafCellsOf(const PostGrid& posts, std::uint64_t mostFine = kMostFineSquares);

/// Says how many meshes a patch has, and how many octaves their tolerances are apart.
struct PatchVariants {
  std::size_t count;
  double octaves;
};
/// Returns the variants for a side of the smallest squares.
PatchVariants variantsOf(std::uint32_t leafCells);

/// Makes the patches, diamonds, pages and their links for a grid of posts. Bounds, errors and triangle counts
/// have their size but no values.
PatchIndex makePatchIndex(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t leafCells);

/// Returns the tolerance of every depth, metres: `leafM` at the deepest, and sqrt(2) times as much at each
/// depth above.
std::vector<double> patchTolerances(const PatchIndex& index, double leafM);
/// Returns a tenth of the distance of posts. The Himalaya at 3 arc seconds then needs two fifths of its
/// posts, hills fewer.
double defaultLeafToleranceM(const PostGrid& posts);

/// Counts the triangles of each variant of a patch.
void countTriangles(const PatchMesh& mesh, std::span<std::uint16_t> triangles);
/// Fills bounds, errors and triangles of the index from the patches' own, given page by page. It makes errors
/// and bounds grow up the tree.
void finishPatchIndex(PatchIndex& index, std::vector<Box> ownBounds, VariantTable<float> ownErrorM,
                      VariantTable<std::uint16_t> triangles);

}  // namespace trimtab::terrain
