#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "static_lod_parts.h"
#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/culling/select_static.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::terrain {
struct StaticLodTerrain;
}

namespace trimtab::scene {

/// Finds the nodes of the static trees that a frame draws. It reuses the last frame's cut and visible set if
/// nothing that they depend on has changed. It needs no GL context.
class StaticLodCulling {
 public:
  void setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain);

  /// Selects the cut and the visible set for an eye, each only if it can have changed, and returns how often
  /// it did: `cutsSelected` and `visibleSelected` are 0 or 1.
  FrameCounters select(const FrameRequest& request, const EyePose& eye);
  /// Returns the size of the depth map with which far nodes are tested against near ones. If they are not
  /// tested, the result has no size and its `note` may say why.
  OcclusionResult occlusion(const FrameRequest& request) const;
  /// Removes the far nodes that `covered` hides from the visible set.
  void removeHidden(const DepthPyramid& covered);
  /// Reports whether removeHidden() ran for this view, so that no map needs to be read again.
  bool hiddenIsKnown() const { return hiddenIsKnown_; }

  const StaticLodIndex& index() const;
  const std::vector<TileDraw>& cut() const { return cut_.tiles; }
  /// Lists near nodes before far ones, in every culling case and view direction: where two triangles have the
  /// same depth, the first one drawn shows, so the order must not change the image.
  const VisibleSet& visible() const { return visible_; }
  std::size_t visibleNear() const { return visibleNear_; }
  void plant(const Defects& defects);
  StaticLodFrame frame() const { return staticLodFrame(index(), visible_); }

 private:
  void orderByDistance(Vec3 eye);
  void countVertices();
  std::uint64_t hideableTriangles(Vec3 eye) const;

  /// Holds what the cut depends on. It is not the CutKey of tiles and patches: the rule is document E's, and
  /// the cut may be one level of all trees.
  struct TreeCutKey {
    Vec3 eye;
    ErrorMeasure error = ErrorMeasure::rms;
    StaticLodRule rule;
    int depth = -1;
    friend bool operator==(const TreeCutKey&, const TreeCutKey&) = default;
  };

  std::shared_ptr<const terrain::StaticLodTerrain> terrain_;
  std::vector<std::uint32_t> vertices_;  ///< one a node
  std::optional<TreeCutKey> cutKey_;
  std::vector<float> errors_;  ///< of the cut's measure, one per node; empty: not made yet
  LevelCut cut_;
  std::size_t near_ = 0;  ///< of the cut
  VisibleSet visible_;
  std::size_t visibleNear_ = 0;
  /// Holds what the visible set depends on, hidden nodes included.
  struct VisibleKey {
    TreeCutKey cut;
    EyePose eye;
    ViewShape view;
    CullingCase method = CullingCase::proposed;
    std::optional<OcclusionResolution> map;
    double farM = 0;
    bool picture = false;
    friend bool operator==(const VisibleKey&, const VisibleKey&) = default;
  };
  std::optional<VisibleKey> visibleKey_;
  bool hiddenIsKnown_ = false;
  StaticLodParts parts_;
  std::vector<double> distances_;
  std::vector<TileDraw> far_;
  std::vector<std::uint8_t> flags_;
  Defects defects_;
};

}  // namespace trimtab::scene
