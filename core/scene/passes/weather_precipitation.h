#pragma once

#include <optional>

#include "trimtab/culling/select.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/weather_decision.h"

namespace trimtab::scene {

/// Says what falls in one frame. Without density there is no such view.
struct PrecipitationView {
  Precipitation kind = Precipitation::rain;
  double density = 0;  ///< 0..1, the intensity of osgParticle::PrecipitationEffect
  double amount = 0;   ///< 0..1: as the density, but for the bounded form while it fades
  PrecipitationForm form = PrecipitationForm::bounded;
  double share = 1;  ///< of the particles of that intensity, those that are drawn, 0..1
  /// The size of the view relative to the image, 0..1. Whether a particle is too small to be seen is decided
  /// in the image's pixels, or rain would vanish from a scene that is drawn smaller. The published effect
  /// ignores it.
  double renderScale = 1;
  double time = 0;  ///< seconds; the place of each drop depends on it alone
  Vec3 velocity;  ///< of the eye through the air, metres per second in the local frame; drops streak along it
  Vec3 airDrift;  ///< how far the wind has carried the air, metres in the local frame
  PrecipitationLook look{};
};

/// Returns the view of what falls; unset if nothing does.
std::optional<PrecipitationView> precipitationView(const FrameRequest& request, const LocalFrame& frame);

/// Returns where the corner of a cell is, relative to the eye; cells stand still in the world. The effect
/// gives each cell a pattern by its number, which repeats after kCellsUntilSame cells along x and y and
/// after each cell along z.
Vec3 latticeFromEye(Vec3 eye, Vec3 cell);
inline constexpr double kCellsUntilSame = 100;

}  // namespace trimtab::scene
