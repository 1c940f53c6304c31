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

/// What a frame does to find the nodes of the static trees that it draws. Keeps what can be kept from frame
/// to frame; needs no context.
class StaticLodCulling {
 public:
  void setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain);

  /// Selects cut and visible set for an eye, each only if it can have changed, and returns how often: its
  /// `cutsSelected` and `visibleSelected` are 0 or 1.
  FrameCounters select(const FrameRequest& request, const EyePose& eye);
  /// Returns the size of the depth map by which far nodes are tested against what the near ones cover;
  /// without one, `note` may say why.
  OcclusionResult occlusion(const FrameRequest& request) const;
  /// Takes the far nodes out that `covered` hides.
  void removeHidden(const DepthPyramid& covered);
  /// That was done for this very view: no map needs to be read again.
  bool hiddenIsKnown() const { return hiddenIsKnown_; }

  const StaticLodIndex& index() const;
  const std::vector<TileDraw>& cut() const { return cutTiles_; }
  /// The near nodes first, the far ones after them: in every culling case and view direction, because where
  /// two triangles have the same depth, the first one shows.
  const VisibleSet& visible() const { return visible_; }
  std::size_t visibleNear() const { return visibleNear_; }
  void plant(const Defects& defects);
  StaticLodFrame frame() const { return staticLodFrame(index(), visible_); }

 private:
  void orderByDistance(Vec3 eye);
  std::uint64_t hideableTriangles(Vec3 eye) const;

  /// What the cut depends on.
  struct CutKey {
    Vec3 eye;
    ErrorMeasure error = ErrorMeasure::rms;
    double distancePerError = 0;
    int depth = -1;
    friend bool operator==(const CutKey&, const CutKey&) = default;
  };

  std::shared_ptr<const terrain::StaticLodTerrain> terrain_;
  std::vector<std::uint32_t> vertices_;  ///< one a node
  std::optional<CutKey> cutKey_;
  std::vector<float> errors_;  ///< of the cut's measure, one per node; empty: not made yet
  StaticCut cut_;
  std::vector<TileDraw> cutTiles_;
  std::size_t near_ = 0;  ///< of the cut
  VisibleSet visible_;
  std::size_t visibleNear_ = 0;
  /// What the visible set depends on, hidden nodes included.
  struct VisibleKey {
    CutKey cut;
    EyePose eye;
    ViewShape view;
    CullingCase method = CullingCase::proposed;
    std::optional<DepthMapSize> map;
    double farM = 0;
    bool picture = false;
    friend bool operator==(const VisibleKey&, const VisibleKey&) = default;
  };
  std::optional<VisibleKey> visibleKey_;
  bool hiddenIsKnown_ = false;
  StaticLodParts parts_;
  std::vector<double> distances_;
  std::vector<std::uint32_t> far_;
  std::vector<std::uint8_t> flags_;
  Defects defects_;
};

}  // namespace trimtab::scene
