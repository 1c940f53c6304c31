#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/select.h"
#include "trimtab/frame/patch_index.h"

/// Selects the patches that a frame draws, and the pages that it would draw from if they were resident.
namespace trimtab {

/// A page that would improve a view.
struct PageWant {
  std::uint32_t page = 0;
  /// Largest screen-space error, pixels, of what is drawn while the page is missing; infinite for root pages
  /// and around the eye. It is never larger than that of the pages it depends on.
  float errorPx = 0;
};

struct PatchCut {
  LevelCut cut;  ///< node is a patch, `coarser` its variant; the order depends on the index only
  /// Every page that the cut would use if all pages were resident, and the pages above them; each once.
  std::vector<PageWant> wants;
  std::size_t heldBack = 0;  ///< diamonds of the cut that should be split but wait for a page

  // Working storage of selectPatches, kept so that a frame allocates nothing.
  std::vector<float> need;               ///< one per diamond: (error / distance) squared; 0: not split
  std::vector<std::uint8_t> lack;        ///< one per diamond that should be split: what it waits for
  std::vector<std::uint32_t> splitList;  ///< diamonds that should be split
  std::vector<std::uint32_t> stack, wantOf;
};

/// Fills `cut` with patches whose screen-space error at `eye` is what the rule accepts where the data and the
/// resident pages allow it; each patch in its coarsest variant that is good enough. `resident` has
/// one flag per page, not 0 if the page may be drawn; empty means all. If a root page is missing because it
/// cannot be read, the next finer pages are drawn in its place at any distance, and nothing where these are
/// missing too. The cut does not depend on the view direction or on culling. The cost grows with the cut, not
/// with the index.
///
/// A diamond should be split if one of its patches is not good enough at its finest, or if a diamond that
/// depends on it should be split. It is split if its children are resident and every diamond that it depends
/// on is split. So one more resident page never makes any part of the image coarser.
void selectPatches(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye,
                   const CutRule& rule, PatchCut& cut);

}  // namespace trimtab
