#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/renderer.h"

namespace trimtab::scene {

struct CutNumber {
  std::uint64_t cut = 0;   ///< another one for another cut
  std::uint64_t rule = 0;  ///< another one where not only the eye differs that it was made for
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
  /// The surfaces of the cut's nodes, in its order.
  virtual void fill(std::vector<HorizonTile>& tiles) = 0;

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
