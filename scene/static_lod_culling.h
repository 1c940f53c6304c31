#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trimtab/culling/select_static.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::terrain {
struct StaticLodTerrain;
}

namespace trimtab::scene {

/// What a frame does to find the nodes of the static trees that it draws. Keeps what can be kept from frame
/// to frame; needs no context.
class StaticLodCulling {
 public:
  void setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain);

  /// Whether trees stand for the terrain in this frame: there are some, and the parameters or an overlay ask
  /// for them.
  bool wanted(const FrameRequest& request) const;
  /// Cut and visible set for an eye; the cut only if it can have changed, which counts as `cutsSelected`.
  void select(const FrameRequest& request, const EyePose& eye, FrameResult& counters);
  /// Takes nodes out of the visible set: one flag a node of it, 1 is proven hidden.
  void removeHidden(std::span<const std::uint8_t> flags);

  const StaticLodIndex& index() const;
  const std::vector<TileDraw>& cut() const { return cutTiles_; }
  const VisibleSet& visible() const { return visible_; }
  StaticLodFrame frame() const { return staticLodFrame(index(), visible_); }

 private:
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
  StaticCut cut_;
  std::vector<TileDraw> cutTiles_;
  VisibleSet visible_;
};

}  // namespace trimtab::scene
