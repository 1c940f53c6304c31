#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// Builds patches from the posts alone, one page at a time, and states for each mesh a vertical error that
/// holds at every post. Pages can be built in any order, by several threads or machines, with the same result
/// to the byte.
/// trimtab/frame/patch_index.h says what patches are; resources/docs/levels-of-detail.md ("Patches") says why
/// they fit without cracks.
namespace trimtab::terrain {

/// A page and what was measured on its patches. Each list has one entry per patch, in the index's order.
/// Bounds (local frame, metres) and errors are a patch's own; finishPatchIndex() later enlarges them to those
/// of the descendants.
struct BuiltPage {
  PatchPage meshes;
  std::vector<PatchFacts> facts;
  std::vector<Box> bounds;
  VariantTable<float> errorM;
  std::vector<NormalCone> cones;
};
/// A page with more posts a side than this is meshed on every 2nd, 4th, ... of them, and measured on all.
inline constexpr std::uint32_t kMostPostsASide = 1025;
/// Meshes and measures one page. `index` is that of makePatchIndex() for the posts of `heights` and needs no
/// measured values yet; `geometry` is that of the same posts.
///
/// `tolerances` has, by depth, the error in metres that the finest variant aims at (patchTolerances). A patch
/// may miss it: vertices are rounded and limited in number, and large pages are meshed on some of the posts.
/// `BuiltPage::errorM` is the error that it keeps.
///
/// Memory grows with the posts that the page is meshed on, not with all that it covers, because those are
/// measured strip by strip. `carryOn` is called on the calling thread, at least once per patch; if it returns
/// false, the result has no patches. Failed reads of `heights` are not reported: ask HeightSource::failed()
/// afterwards, and discard the page.
BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances,
                    const std::function<bool()>& carryOn = {});

/// Builds all pages on many threads (forEachParallel), returns when all are built, and keeps them in memory.
/// The result is never null. `leafToleranceM` is the error that the smallest patches aim at. `leafCells` is
/// the side of the smallest squares, kFineLeafCells or kCoarseLeafCells; without it leafCellsOf() chooses.
/// Ask `heights.failed()` here too.
std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM,
                                                 std::uint32_t leafCells);
inline std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM) {
  return buildPatches(heights, leafToleranceM, leafCellsOf(heights.posts()));
}

}  // namespace trimtab::terrain
