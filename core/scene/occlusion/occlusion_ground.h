#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/scene/terrain/surfaces_in_use.h"
#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/surface_tree.h"
#include "trimtab/scene/distance_image.h"

namespace trimtab::scene {

struct CutNumber {
  std::uint64_t cut = 0;         ///< another one for another cut
  std::uint64_t rule = 0;        ///< another one where not only the eye differs that it was made for
  double errorOverDistance = 0;  ///< of that rule, as MovingHorizon takes it
  friend bool operator==(const CutNumber&, const CutNumber&) = default;
};

/// The ground as an OcclusionStage sees it, whatever form it is drawn in. Needs no context.
class OcclusionGround {
 public:
  OcclusionGround() = default;
  OcclusionGround(const OcclusionGround&) = delete;
  OcclusionGround& operator=(const OcclusionGround&) = delete;
  virtual ~OcclusionGround() = default;

  /// Of this frame.
  virtual const LevelCut& cut() const = 0;
  virtual const CutNumber& cutNumber() const = 0;
  /// Why nothing may be hidden from this eye, a sentence; empty when it may.
  virtual std::string refusal(const EyePose& eye, const ViewShape& view) = 0;
  /// Makes surfaces of the cut's nodes for `fill` and `isGraph`, within the frame's share; returns how many
  /// lack.
  virtual std::size_t makeSurfaces(Vec3 eye) = 0;
  /// The surfaces of the cut's nodes, in its order; where there is none of any variant, the lid of the box.
  /// They stay as they are until the next call.
  virtual void fill(std::vector<HorizonTile>& tiles) = 0;
  /// What may stand in the place of what.
  virtual SurfaceTree tree() const = 0;
  /// Of any node, whether it may hide others where it is drawn.
  virtual bool mayOcclude(std::uint32_t node) = 0;
  /// Of a node of the cut, as MovingHorizon::Frame says.
  virtual bool takesRoom(std::uint32_t node) const = 0;
  /// Nothing that `fill` gave is in use any more.
  virtual void forgetOthers() = 0;
  /// False where a place may have two heights, as far as is known: nothing may hide anything.
  virtual bool isGraph() { return true; }

  // The processor's depth map.
  /// One a tile of `visible`, as removeOccluded takes it.
  virtual std::span<const std::uint8_t> hiddenByMap(std::span<const TileDraw> visible, const EyePose& eye,
                                                    const ViewShape& view, DepthMapSize size,
                                                    double loweringScale) = 0;
  virtual DistanceImage mapPicture() const = 0;

  /// Surfaces that a frame may make.
  SurfaceShare& share() { return share_; }

 private:
  SurfaceShare share_;
};

}  // namespace trimtab::scene
