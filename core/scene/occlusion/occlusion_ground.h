#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene/surface/surfaces_in_use.h"
#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/select_objects.h"
#include "trimtab/culling/surface_tree.h"

namespace trimtab::scene {

/// Identifies a LOD cut.
struct CutNumber {
  std::uint64_t cut = 0;         ///< a new number for each new cut
  std::uint64_t rule = 0;        ///< a new number if the cut differs by more than the eye it was selected for
  double errorOverDistance = 0;  ///< of that rule: MovingHorizon::Frame::errorOverDistance
  friend bool operator==(const CutNumber&, const CutNumber&) = default;
};

/// The ground as OcclusionStage sees it, in any form of the terrain: tiles or patches. Needs no GL context.
class OcclusionGround {
 public:
  OcclusionGround() = default;
  OcclusionGround(const OcclusionGround&) = delete;
  OcclusionGround& operator=(const OcclusionGround&) = delete;
  virtual ~OcclusionGround() = default;

  /// Return the cut of this frame and its number.
  virtual const LevelCut& cut() const = 0;
  virtual const CutNumber& cutNumber() const = 0;
  /// Returns a sentence that says why nothing may be hidden from this eye, or an empty string if ground may
  /// be.
  virtual std::string refusal(const EyePose& eye, const ViewShape& view) = 0;
  /// Makes surfaces of the cut's nodes for `fill` and `isGraph`, no more than share() allows. Returns how
  /// many are still missing.
  virtual std::size_t makeSurfaces(Vec3 eye) = 0;
  /// Appends the surface of each node of the cut, in its order; if a node has none, the lid of its box. They
  /// do not change until the next call.
  virtual void fill(std::vector<HorizonTile>& tiles) = 0;
  /// Returns which surfaces may replace which.
  virtual SurfaceTree tree() const = 0;
  /// Returns whether a node may hide others if it is drawn.
  virtual bool mayOcclude(std::uint32_t node) = 0;
  /// Implements MovingHorizon::Frame::replacementsStayNear for a node of the cut.
  virtual bool replacementsStayNear(std::uint32_t node) const = 0;
  /// Allows surfaces that `fill` handed out to be freed, because no horizon uses them any more.
  virtual void forgetOthers() = 0;
  /// Returns false if, as far as is known, a place may have two heights. Then there is no horizon.
  virtual bool isGraph() { return true; }

  /// Returns the limit on surfaces made per frame.
  SurfaceShare& share() { return share_; }

  /// Starts with what stands on this ground, or with nothing if it is null: a box per cell of the objects.
  void setObjects(const ObjectIndex* objects);
  /// Returns what else may be hidden: one box per cell.
  std::span<const HorizonTile> boxes() const { return boxes_; }

 private:
  SurfaceShare share_;
  std::vector<Relief> reliefs_;     ///< of the cells
  std::vector<HorizonTile> boxes_;  ///< one for each of them
};

}  // namespace trimtab::scene
