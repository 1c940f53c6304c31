#pragma once

#include <memory>

#include "core/scene/occlusion/occlusion_ground.h"
#include "trimtab/culling/select_patches.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/terrain/format/pager.h"

namespace trimtab::scene {

class PatchLayer;

/// Selects the cut of patches for an eye and pages in what it needs within a budget of bytes. Keeps what can
/// be kept from frame to frame.
///
/// What the budget does not hold is drawn coarser, so that the largest errors are removed first. The image
/// that paging ends with depends on the request alone.
class PatchCulling {
 public:
  PatchCulling();
  ~PatchCulling();
  /// Starts with another terrain and begins to read its roots, or with none if it is null.
  void setTerrain(std::shared_ptr<const terrain::PatchTerrain> terrain);
  void plant(const Defects& defects);

  struct Paged {
    PagingFrame paging;
    std::uint64_t cutsSelected = 0;
  };
  /// Takes in pages that have arrived, within the frame's share; selects the cut of `eye`, asks for the pages
  /// that it misses, and drops those that are over the budget and were unused for longest. It waits only for
  /// the roots, once, or with `request.waitForPages` for every page that this view can use. The context must
  /// be current, and `layer` must have this terrain's index; pages that it has lost are read again.
  Paged page(const FrameRequest& request, const EyePose& eye, PatchLayer& layer);
  const PatchIndex& index() const;
  const LevelCut& cut() const { return cut_.cut; }
  const CutNumber& cutNumber() const;
  /// Returns a patch's mesh, valid until the next `page`; null if its page is not there.
  const terrain::PatchMesh* meshOf(std::uint32_t patch) const;
  /// Returns the pages that could not be read; the terrain stays coarser there.
  Findings failures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  PatchCut cut_;
};

}  // namespace trimtab::scene
