#include "weather_precipitation.h"

#include <algorithm>
#include <cmath>

#include "trimtab/frame/frame_request.h"

namespace trimtab::scene {
namespace {

/// The effect lays its cells out anew for each density, so the share that a policy moves goes in steps.
constexpr double kShareSteps = 32;

}  // namespace

std::optional<PrecipitationView> precipitationView(const FrameRequest& request, const LocalFrame& frame) {
  const bool bounded = request.precipitationForm == PrecipitationForm::bounded;
  const FadingPrecipitation falls = fallsNow(request);
  if (falls.kind == Precipitation::none ||
      !(falls.density > 0 && falls.amount > 0 && request.levers.drawn.particleShare > 0))
    return {};
  Vec3 eye;
  if (request.velocity)
    eye = {request.velocity->east.value(), request.velocity->north.value(), -request.velocity->down.value()};
  const Mat3 toEarth = transposed(eastNorthUp(request.eye.latitude, request.eye.longitude));
  return PrecipitationView{
      .kind = falls.kind,
      .density = std::min(falls.density, 1.0),
      .amount = std::min(falls.amount, 1.0),
      .form = request.precipitationForm,
      .share =
          bounded ? std::min(request.levers.drawn.particleShare, 1.0)
                  : std::max(std::round(request.levers.drawn.particleShare * kShareSteps), 1.0) / kShareSteps,
      .renderScale =
          request.levers.drawn.renderScale > 0 ? std::min(request.levers.drawn.renderScale, 1.0) : 1,
      .time = request.time,
      .velocity = frame.ecefToLocal() * (toEarth * (eye - eastNorthUp(request.wind))),
      .airDrift = frame.ecefToLocal() * request.airDrift,
      .look = falls.kind == Precipitation::snow ? request.snow : request.rain};
}

// The effect numbers cells from its position and shifts each one's fall by i * 0.43 + j * 0.64 of a period:
// whole after 100 cells, so the eye's place may be taken modulo that many and nothing jumps.
Vec3 latticeFromEye(Vec3 eye, Vec3 cell) {
  return {-std::fmod(eye.x, kCellsUntilSame * cell.x), -std::fmod(eye.y, kCellsUntilSame * cell.y),
          -std::fmod(eye.z, cell.z)};
}

}  // namespace trimtab::scene
