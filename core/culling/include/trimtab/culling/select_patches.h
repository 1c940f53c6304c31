#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/select.h"
#include "trimtab/frame/patch_index.h"

/// Selects the patches that a frame draws, and the pages that it would draw from if they were resident.
namespace trimtab {

/// A page that a view would draw from, or that such a page depends on. It may be resident already.
struct PageWant {
  std::uint32_t page = 0;
  /// The largest screen-space error, pixels, of what is drawn while the page is missing. It is infinite for
  /// root pages, for what replaces a missing root page, and where the eye is inside a patch's bounds. It is
  /// never larger than that of the pages it depends on.
  float errorPx = 0;
};

struct PatchCut {
  LevelCut cut;  ///< `node` is a patch, `variant` its mesh; the order depends on the index only
  /// Every page that the cut would use if all pages were resident, and the pages above them; each once, in no
  /// promised order.
  std::vector<PageWant> wants;
  std::size_t heldBack = 0;  ///< diamonds of the cut that should be split but wait for a page

  // Working storage of selectPatches, kept from frame to frame.
  std::vector<float> need;                   ///< one per diamond: (error / distance) squared; 0: not to split
  std::vector<std::uint8_t> missing;         ///< one per diamond: flags of what it waits for
  std::vector<std::uint32_t> splitList;      ///< diamonds that should be split
  std::vector<std::uint32_t> stack, wantOf;  ///< `wantOf`: one per page, 1 + its place in `wants`, or 0
};

/// Fills `cut` with patches whose screen-space error at `eye` (local frame) is what the rule accepts where
/// the data and the resident pages allow it, each patch in its coarsest variant that is good enough.
/// `resident` has one flag per page, not 0 if the page may be drawn; empty means all. An eye that is not
/// finite gets the root patches. The cut does not depend on the view direction or on culling.
///
/// A diamond should be split if one of its patches is not good enough at its finest, or if a diamond that
/// depends on it should be split. One that should be split is split if its children are resident and every
/// diamond that it depends on is split. So one more resident page never makes any part of the image coarser,
/// unless it is a root page.
///
/// A root page that is not resident counts as one that cannot be read, so wait for the root pages before the
/// first call. The next finer pages are drawn in its place at any distance. Where these are missing too,
/// `cut` has patches of the missing root page itself, and the caller must draw nothing for them.
///
/// The cost grows with the cut that all pages together would give, not with the index; only the first call
/// with another index allocates and clears lists of its size. Threads may call it at once, each with a `cut`
/// of its own.
void selectPatches(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye,
                   const CutRule& rule, PatchCut& cut);

}  // namespace trimtab
