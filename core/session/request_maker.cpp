#include "trimtab/session/request_maker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trimtab/decision/decide.h"
#include "trimtab/motion/line_of_sight.h"
#include "trimtab/weather/weather.h"

namespace trimtab {
namespace {

bool samePose(const AircraftState& a, const AircraftState& b) {
  return a.position == b.position && a.attitude == b.attitude && a.head == b.head && a.view == b.view;
}

/// Returns the symbols of the host that an image at `timeS` does not show, because they flash.
std::vector<std::uint16_t> darkAt(double timeS, const HostSymbols* symbols, const TuningParameters& p) {
  if (symbols == nullptr || !p.symbology.enabled || !p.symbolHost.show) return {};
  return darkSymbols(*symbols, timeS);
}

/// Returns the aircraft's state for symbols; what the host does not send is derived from its positions, and
/// labelled so.
SymbologyState symbolsOf(const ImageOf& image) {
  const AircraftState& eye = image.eye;
  SymbologyState symbols;
  symbols.aircraft = eye.attitude;
  symbols.view = lineOfSight(eye.attitude, eye.head);
  symbols.altitude = eye.position.height;
  symbols.velocity = image.velocity;
  symbols.speed = eye.airspeed;
  symbols.groundSpeed = !eye.airspeed;
  if (!eye.airspeed && symbols.velocity)
    symbols.speed =
        MetresPerSecond{std::hypot(symbols.velocity->north.value(), symbols.velocity->east.value())}
            .as<Knots>();
  return symbols;
}

}  // namespace

FrameRequest RequestMaker::make(const ImageOf& image, const TuningParameters& p, double now,
                                const ImageSize& size) {
  const AircraftState& eye = image.eye;
  FrameRequest request;
  request.time = eye.time;
  request.eye = eye.position;
  request.velocity = image.velocity;
  request.wind = windOf(eye, p.weather);
  drift_.advance(eye.time, eye.position, request.wind);
  request.airDrift = drift_.metres();
  request.attitude = lineOfSight(eye.attitude, eye.head);
  request.view = viewShape(p.view, size.widthPx, size.heightPx, eye.view);
  if (size.fit == ViewFit::fill && p.view.renderSize == RenderSize::fit)
    request.view = filledShape(request.view);
  request.decision = image.decision;
  MotionBlur& blur = request.decision.motion.blur;
  if (blur.strength > 0) {
    if (!blurPicturedAt_) blurPicturedAt_ = now;
    blur.remainingMs -= std::max(now - *blurPicturedAt_, 0.0) * 1e3;
    if (!(blur.remainingMs > 0)) blur = {};
  }
  request.cullingCase = p.culling.cullingCase;
  request.occlusion = p.culling.occlusion;
  request.backFaces = p.culling.backFaces;
  request.spreadFrom = p.lod.spreadFrom;
  request.scaleTexture = p.lod.texture;
  request.lightPx = p.objects.lightSize.value();
  request.staticLod = p.staticLod;
  request.terrain = p.terrain;
  request.levers = leversOf(request.decision, p);
  request.rain = p.rainLook;
  request.snow = p.snowLook;
  request.precipitationForm = p.weather.precipitationForm;
  fade_.advance(eye.time, image.decision.weather);
  request.fading = fade_.fading();
  drawnDark_ = darkAt(eye.time, image.symbols.get(), p);
  if (p.symbology.enabled)
    request.symbology = SymbologyRequest{symbolsOf(image), symbologySetup(p), image.symbols, drawnDark_};
  drawnEye_ = eye;
  return request;
}

bool RequestMaker::differs(const AircraftState& eye, const HostSymbols* symbols,
                           const TuningParameters& p) const {
  return !drawnEye_ || !samePose(eye, *drawnEye_) || darkAt(eye.time, symbols, p) != drawnDark_;
}

}  // namespace trimtab
