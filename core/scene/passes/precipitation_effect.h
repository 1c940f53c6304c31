#pragma once

#include <memory>

#include "scene_view.h"

namespace trimtab::scene {

/// Draws osgParticle::PrecipitationEffect under our conventions: reversed depth, an eye at the origin, and
/// an image that depends on its request alone. The effect chooses the cells around the eye and draws each;
/// the shaders are ours. OpenSceneGraph draws nothing else. The context must be current for all of its life.
class PrecipitationEffect {
 public:
  PrecipitationEffect();
  /// Frees OSG's GL objects.
  ~PrecipitationEffect();
  PrecipitationEffect(const PrecipitationEffect&) = delete;
  PrecipitationEffect& operator=(const PrecipitationEffect&) = delete;

  /// Draws into the framebuffer that is bound, which is `fbo`, over what its depth says is farther.
  void draw(const PrecipitationView& falling, const SceneView& view, unsigned fbo);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
