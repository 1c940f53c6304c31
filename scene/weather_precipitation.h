#pragma once

#include <memory>
#include <optional>

#include "trimtab/culling/select.h"
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

/// osgParticle::PrecipitationEffect under our conventions: reversed depth, an eye at the origin, a picture
/// that depends on its request alone. The effect chooses the cells around the eye and draws each; cells stand
/// still in the world, and the shaders are ours.
class PrecipitationNode {
 public:
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
