#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/surface_tree.h"
#include "trimtab/scene/renderer.h"

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
  virtual ~OcclusionGround() = default;

  /// Of this frame.
  virtual const LevelCut& cut() const = 0;
  virtual const CutNumber& cutNumber() const = 0;
  /// Why nothing may be hidden from this eye; empty when it may.
  virtual std::string refusal(const EyePose& eye, const ViewShape& view) = 0;
  /// The surfaces of the cut's nodes, in its order. They stay as they are until the next call.
  virtual void fill(std::vector<HorizonTile>& tiles) = 0;
  /// What may stand in the place of what.
  virtual SurfaceTree tree() const = 0;
  /// Of any node, whether it may hide others where it is drawn.
  virtual bool mayOcclude(std::uint32_t node) = 0;
  /// False where a place may have two heights: nothing may hide anything.
  virtual bool isGraph() { return true; }

  // The processor's depth map.
  virtual bool drawsMap() const { return false; }
  /// One a tile of `visible`, as removeOccluded takes it.
  virtual std::span<const std::uint8_t> hiddenByMap(std::span<const TileDraw> /*visible*/,
                                                    const EyePose& /*eye*/, const ViewShape& /*view*/,
                                                    DepthMapSize /*size*/, double /*loweringScale*/) {
    return {};
  }
  virtual Renderer::Grey mapPicture() const { return {}; }
};

}  // namespace trimtab::scene
