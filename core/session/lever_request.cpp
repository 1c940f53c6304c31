#include "trimtab/session/lever_request.h"

namespace trimtab {

void applyLevers(const PolicyOutcome& policy, FrameRequest& request) {
  if (policy.moved == 0) return;
  if (policy.moves(Lever::screen_space_error)) {
    request.lod.screenSpaceError = Pixels{policy[Lever::screen_space_error]};
    request.staticLod.errorPx = request.lod.screenSpaceError;
  }
  WeatherDecision& weather = request.decision.weather;
  if (policy.moves(Lever::far_distance)) {
    weather.farM *= policy[Lever::far_distance];
    weather.nearFarRatio /= policy[Lever::far_distance];
  }
  if (policy.moves(Lever::particle_density)) request.particleShare = policy[Lever::particle_density];
  MotionBlur& blur = request.decision.motion.blur;
  if (policy.moves(Lever::blur_strength)) blur.strength *= policy[Lever::blur_strength];
  if (policy.moves(Lever::render_scale)) request.renderScale = policy[Lever::render_scale];
}

}  // namespace trimtab
