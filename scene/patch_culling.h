#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/pager.h"

namespace trimtab::scene {

class PatchLayer;

/// What a frame does to find the patches that it draws, and to have them there: cut, paging within a budget,
/// visible set. Keeps what can be kept from frame to frame.
class PatchCulling {
 public:
  PatchCulling();
  ~PatchCulling();
  void setTerrain(std::shared_ptr<const terrain::PatchTerrain> terrain);

  /// Takes in what has arrived, within the frame's share; chooses the cut and asks for what it lacks, gives
  /// up what is longest unused and over the budget. Waits for nothing, but with `request.waitForPages` for
  /// all that this view can use. The context is current.
  void page(const FrameRequest& request, const EyePose& eye, PatchLayer& layer, FrameResult& counters);
  void selectVisible(const FrameRequest& request, const EyePose& eye);

  const PatchIndex& index() const;
  const LevelCut& cut() const { return cut_.cut; }
  const VisibleSet& visible() const { return visible_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  PatchCut cut_;
  VisibleSet visible_;
};

}  // namespace trimtab::scene
