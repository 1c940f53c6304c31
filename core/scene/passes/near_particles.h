#pragma once

#include <cstddef>
#include <vector>

#include "trimtab/units/linear.h"

namespace trimtab::scene {

struct PrecipitationView;
struct SceneView;

/// A drop or flake near the eye.
struct NearParticle {
  Vec3 place;  ///< eye axes, metres; it streaks from there
  double radiusM = 0;
  double lengthM = 0;   ///< of its streak, along that of ParticleMotion
  double strength = 0;  ///< 0..1, of its opacity at the middle
};

/// Says how all particles of a frame move and look.
struct ParticleMotion {
  Vec3 fall;    ///< through the local frame while it lies in still air, metres per second
  Vec3 streak;  ///< eye axes, metres: from a particle back to where it was when the exposure began
  double radiusM = 0;
};
ParticleMotion particleMotion(const PrecipitationView& falling, const SceneView& view);

/// No frame draws more particles than that.
inline constexpr std::size_t kMostParticles = 12'000;

/// Replaces `particles` by those in view. Each stands in a lattice of cells that the air carries and that
/// falls through it, at a place that follows from a hash of its cell and number, so the result depends on the
/// arguments alone. There are as many at each distance as the image can show: few near the eye, where each
/// covers many pixels, and none where one is narrower than a pixel or lost in fog. `share` and `amount` of
/// `falling` lower their number; the last of a cell fades, so that nothing appears at once. With a smaller
/// share, those that are left are stronger by as much, as far as none is more than opaque, so that rain looks
/// as dense and takes less time.
///
/// Costs some 20 ns per particle. Numbers that are not finite count as 0; a view without an area has no
/// particles.
void findNearParticles(const PrecipitationView& falling, const SceneView& view,
                       std::vector<NearParticle>& particles);

}  // namespace trimtab::scene
