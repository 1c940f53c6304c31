#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scene/passes/near_particles.h"

namespace trimtab::scene {

/// A corner of a particle's quad, as particle.vert.glsl reads it.
struct ParticleCorner {
  float x, y, w;  ///< of clip space; z is the near distance, because depth is near / distance
  std::array<std::uint8_t, 4> shape;  ///< across and along the streak, 0..255 from edge to edge; strength; 0
};

/// Replaces `corners` by four for each particle, in the order of a strip. Quads are at least two pixels wide,
/// and fainter for it, or they would flicker.
void makeParticleCorners(const std::vector<NearParticle>& particles, const ParticleMotion& motion,
                         const SceneView& view, std::vector<ParticleCorner>& corners);

/// Draws rain and snow at a cost that has a bound (PrecipitationForm::bounded), in one draw. It takes memory
/// at the first drop. The context must be current for all of its life.
class PrecipitationPass {
 public:
  PrecipitationPass();
  ~PrecipitationPass();
  PrecipitationPass(const PrecipitationPass&) = delete;
  PrecipitationPass& operator=(const PrecipitationPass&) = delete;

  /// Draws over a finished scene of the view's size, whose framebuffer is bound, and tests its depth, which
  /// stays as it is. Returns how many particles it drew.
  std::size_t draw(const PrecipitationView& falling, const SceneView& view);

 private:
  void makeBuffers();

  unsigned program_ = 0, array_ = 0, corners_ = 0, indices_ = 0;
  int nearUniform_ = -1, colourUniform_ = -1;
  std::vector<NearParticle> particles_;
  std::vector<ParticleCorner> cornersToDraw_;
};

}  // namespace trimtab::scene
