#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/patch_index.h"

/// Which patches a frame draws, and which pages it would draw from if they were there.
namespace trimtab {

/// A page that is wanted; more urgent the larger its error is in the picture.
struct PageWant {
  std::uint32_t page = 0;
  float errorPx = 0;  ///< of what is drawn in its stead; 0: drawn or nearly so, keep it
};

struct PatchCut {
  LevelCut cut;  ///< tiles: node is a patch, `coarser` its variant; order is a function of the index only
  std::vector<PageWant>
      wants;  ///< every page of the cut, and what was not split for want of pages; no page twice
  std::size_t heldBack = 0;  ///< diamonds that should be halved and are not, for want of a page

  // What selectPatches works with, kept so that a frame allocates nothing.
  std::vector<std::uint8_t> split;       ///< one a diamond
  std::vector<std::uint32_t> splitList;  ///< those that are, to be cleared
  std::vector<std::uint32_t> stack, wantOf;
};

/// Patches whose error at `eye` is at most maxErrorPx x lodScale in the picture where the data and the pages
/// allow; of each the coarsest variant that is. `resident`: one a page, not 0 where it may be drawn; empty:
/// all. The pages of the roots must be. Independent of view direction and of culling.
void selectPatches(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye,
                   double maxErrorPx, double lodScale, double pixelsPerRadian, PatchCut& cut);

/// As selectVisible: `visible.reason` is one a patch; `hidden` one a patch of the cut, or empty.
void selectVisiblePatches(const PatchIndex& index, const LevelCut& cut, const EyePose& eye,
                          const ViewShape& view, bool test, VisibleSet& visible,
                          double farM = std::numeric_limits<double>::infinity(),
                          std::span<const std::uint8_t> hidden = {});

}  // namespace trimtab
