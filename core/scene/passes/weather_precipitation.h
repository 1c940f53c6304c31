#pragma once

#include <memory>
#include <optional>

#include "trimtab/culling/select.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/weather_decision.h"

namespace osg {
class Node;
}

namespace trimtab::scene {

struct SceneView;

/// What falls in one frame. Only where something does: a density of 0 has no view.
struct PrecipitationView {
  Precipitation kind = Precipitation::rain;
  double density = 0;  ///< 0..1, the intensity of osgParticle::PrecipitationEffect
  double time = 0;     ///< seconds; where each drop is, is a function of it and of the place alone
  Vec3 velocity;       ///< of the eye, metres a second in the local frame: drops streak along it
};

/// None where nothing falls.
std::optional<PrecipitationView> precipitationView(const FrameRequest& request, const LocalFrame& frame);

/// Where the corner of a cell stands as seen from the eye: cells stand still in the world. The effect gives
/// each cell a pattern by its number, which repeats after kCellsUntilSame along x and y and each cell along
/// z.
Vec3 latticeFromEye(Vec3 eye, Vec3 cell);
inline constexpr double kCellsUntilSame = 100;

/// osgParticle::PrecipitationEffect under our conventions: reversed depth, an eye at the origin, a picture
/// that depends on its request alone. The effect chooses the cells around the eye and draws each; cells stand
/// still in the world, and the shaders are ours.
class PrecipitationNode {
 public:
  static constexpr int kFirstBin = 10, kLastBin = 12;  ///< render bins it draws in: points, lines, quads

  PrecipitationNode();
  ~PrecipitationNode();
  PrecipitationNode(const PrecipitationNode&) = delete;
  PrecipitationNode& operator=(const PrecipitationNode&) = delete;

  osg::Node* node() const;
  void set(const std::optional<PrecipitationView>& falling, const SceneView& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
