#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// Builds error-bounded levels (core/frame/include/trimtab/frame/patch_index.h says what they are and why
/// they close), a page at a time, from the posts alone: pages can be built in any order, by many threads or
/// machines.
namespace trimtab::terrain {

/// A page and what was measured of its own patches; errors and bounds of descendants are not in them yet.
struct BuiltPage {
  PatchPage meshes;
  std::vector<PatchFacts> facts;
  std::vector<Box> bounds;
  VariantTable<float> errorM;
  std::vector<NormalCone> cones;
};
/// Memory: a few times the posts of a page at no more than kMostPostsASide a side (coarser pages are meshed
/// on every so-manyth post, and measured on all of them, strip by strip). `carryOn` is asked between patches
/// and between strips; when it says no, what comes back has no patches.
inline constexpr std::uint32_t kMostPostsASide = 1025;
BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances,
                    const std::function<bool()>& carryOn = {});

/// All of it in memory, on all cores.
std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM,
                                                 std::uint32_t leafCells);
inline std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM) {
  return buildPatches(heights, leafToleranceM, leafCellsOf(heights.posts()));
}

}  // namespace trimtab::terrain
