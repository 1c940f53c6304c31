#pragma once

#include <memory>
#include <span>
#include <vector>

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
  /// Reading begins at once, with the roots. Null: none.
  void setTerrain(std::shared_ptr<const terrain::PatchTerrain> terrain);
  void plant(const Defects& defects);

  struct Paged {
    PagingFrame paging;
    std::uint64_t cutsSelected = 0;
  };
  /// Takes in what has arrived, within the frame's share; chooses the cut and asks for what it lacks, gives
  /// up what is longest unused and over the budget. Waits for nothing but, once, the roots; with
  /// `request.waitForPages` for all that this view can use. The context is current, and `layer` has this
  /// terrain's index; where it has lost its pages they are read again. `eye`: whose cut it is.
  Paged page(const FrameRequest& request, const EyePose& eye, PatchLayer& layer);
  const PatchIndex& index() const;
  const LevelCut& cut() const { return cut_.cut; }
  const CutNumber& cutNumber() const;
  /// Null where its page is not there; good until the next `page`.
  const terrain::PatchMesh* meshOf(std::uint32_t patch) const;
  /// Pages that could not be read; the terrain stays coarser there.
  Findings failures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  PatchCut cut_;
};

}  // namespace trimtab::scene
