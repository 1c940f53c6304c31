#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/patch_index.h"

/// Which patches a frame draws, and which pages it would draw from if they were there.
namespace trimtab {

/// A page that a view has a use for.
struct PageWant {
  std::uint32_t page = 0;
  /// The largest error, in pixels, of what is drawn in its stead while it is not there; infinite at the roots
  /// and around the eye. No page has more than those it stands on.
  float errorPx = 0;
};

struct PatchCut {
  LevelCut cut;  ///< tiles: node is a patch, `coarser` its variant; order is a function of the index only
  /// Every page of the cut as it would be with all pages there, and those above them; each once.
  std::vector<PageWant> wants;
  std::size_t heldBack = 0;  ///< diamonds of the cut that should be halved and are not, for want of a page

  // What selectPatches works with, kept so that a frame allocates nothing.
  std::vector<float> need;               ///< one a diamond: error over distance, squared; 0: stays whole
  std::vector<std::uint8_t> lack;        ///< one a diamond that is to be halved: what keeps it from it
  std::vector<std::uint32_t> splitList;  ///< diamonds that are to be halved: the entries to be cleared
  std::vector<std::uint32_t> stack, wantOf;
};

/// Patches whose error at `eye` is at most maxErrorPx x lodScale in the picture where the data and the pages
/// allow; of each the coarsest variant that is. `resident`: one a page, not 0 where it may be drawn; empty:
/// all. The pages of the roots should be: where one is not (it cannot be read) what is drawn is as fine as
/// the next pages, however far away, and missing where those are not there either. Independent of view
/// direction and of culling. Costs what the cut does, whatever the size of the index.
///
/// To be halved are the diamonds with a patch that is not good enough at its finest, and those that these
/// stand on; halved are those of them whose children are resident, and which stand on such only. So a page
/// more never makes any part of the picture coarser.
void selectPatches(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye,
                   double maxErrorPx, double lodScale, double pixelsPerRadian, PatchCut& cut);

/// As selectVisible: `visible.reason` is one a patch; `hidden` one a patch of the cut, or empty. Vertices are
/// not counted: the index does not know them.
void selectVisiblePatches(const PatchIndex& index, const LevelCut& cut, const EyePose& eye,
                          const ViewShape& view, bool test, VisibleSet& visible,
                          double farM = std::numeric_limits<double>::infinity(),
                          std::span<const std::uint8_t> hidden = {}, bool backFaces = false);

}  // namespace trimtab
