#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// How a grid of posts is divided into patches (core/frame/include/trimtab/frame/patch_index.h says what
/// patches are).
namespace trimtab::terrain {

/// Sides of the smallest squares. With the finer a view at 2 px takes 1.34 times the triangles of an
/// unconstrained mesh (Everest) instead of 1.44, and the index is four times as long.
inline constexpr std::uint32_t kFineLeafCells = 16, kCoarseLeafCells = 32;
/// As many as a country of 13,000 x 11,000 posts has of the coarser: 1.2 million patches.
inline constexpr std::uint64_t kMostFineSquares = 150'000;
/// The finer side for grids of no more than so many of its squares, else the coarser.
std::uint32_t leafCellsOf(const PostGrid& posts, std::uint64_t mostFine = kMostFineSquares);

/// Of a patch's meshes: how many, and octaves of tolerance from each to the next coarser one.
struct PatchVariants {
  std::size_t count;
  double octaves;
};
/// By the side of the smallest squares.
PatchVariants variantsOf(std::uint32_t leafCells);

/// Patches, diamonds, pages and their links for a grid of posts; bounds, errors and triangle counts are sized
/// and not filled.
PatchIndex makePatchIndex(const PostGrid& posts, const PostGeometry& geometry, std::uint32_t leafCells);

/// Of every depth, metres; falls by the square root of two a depth to `leafM` at the deepest.
std::vector<double> patchTolerances(const PatchIndex& index, double leafM);
/// A tenth of the distance of posts: the Himalaya at 3 seconds take two fifths of their posts, hills less.
double defaultLeafToleranceM(const PostGrid& posts);

/// Triangles of each of a patch's variants.
void countTriangles(const PatchMesh& mesh, std::span<std::uint16_t> triangles);
/// Fills bounds, errors and triangles of the index, so that they are monotone up the tree; `facts` one a
/// patch, `own*` as built, page by page.
void finishPatchIndex(PatchIndex& index, std::vector<Box> ownBounds, VariantTable<float> ownErrorM,
                      VariantTable<std::uint16_t> triangles);

}  // namespace trimtab::terrain
