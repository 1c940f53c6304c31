#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// Builds patches with a guaranteed vertical error, one page at a time, from the posts alone. Pages can be
/// built in any order, by several threads or machines, with the same result to the byte.
/// trimtab/frame/patch_index.h says what patches are; resources/docs/levels-of-detail.md ("Patches") says why
/// they fit without cracks.
namespace trimtab::terrain {

/// A page and what was measured on its patches, one entry per patch. finishPatchIndex() later raises errors
/// and bounds by those of the descendants.
struct BuiltPage {
  PatchPage meshes;
  std::vector<PatchFacts> facts;
  std::vector<Box> bounds;
  VariantTable<float> errorM;
  std::vector<NormalCone> cones;
};
/// A page with more posts a side than this is meshed on every 2nd, 4th, ... post, and measured on all of
/// them.
inline constexpr std::uint32_t kMostPostsASide = 1025;
/// Meshes and measures one page. `tolerances` are the allowed errors in metres by depth (patchTolerances).
/// The memory needed is a few times the posts that the page is meshed on, because it is measured strip by
/// strip. `carryOn` is asked between patches and between strips; if it returns false, the result has no
/// patches.
BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances,
                    const std::function<bool()>& carryOn = {});

/// Builds all pages in memory, on all cores. `leafToleranceM` is the allowed error of the smallest patches.
std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM,
                                                 std::uint32_t leafCells);
inline std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM) {
  return buildPatches(heights, leafToleranceM, leafCellsOf(heights.posts()));
}

}  // namespace trimtab::terrain
