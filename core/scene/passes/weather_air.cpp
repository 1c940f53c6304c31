#include "weather_air.h"

#include <algorithm>
#include <cmath>

#include "core/scene/shaders/light.h"
#include "trimtab/weather/haze_layer.h"

namespace trimtab::scene {
namespace {

/// Fog so thick that the nearest thing a view can hold is gone: exp(-100) at 1 m.
constexpr double kThickest = 100;
/// Thick fog and heavy precipitation are greyer than haze.
constexpr std::array<float, 3> kGrey{0.70f, 0.72f, 0.74f};
/// Per metre: with this rate the fade is over within less than single precision resolves.
constexpr float kNoFade = 1e6f;
/// The shore of the Dead Sea lies 430 m below mean sea level.
constexpr double kLowestGroundM = -500;
/// Visibility of a few kilometres is halfway between the two.
constexpr double kGreyAtM = 1500;

}  // namespace

Air airOf(const WeatherDecision& weather, double farM) {
  Air air;
  air.colour = kHaze;
  if (weather.fogged && weather.extinctionPerM > 0) {
    const double extinction = std::min(weather.extinctionPerM, kThickest);
    air.extinction = static_cast<float>(extinction);
    const float grey = static_cast<float>(1 - std::exp(-extinction * kGreyAtM));
    for (std::size_t i = 0; i < 3; ++i) air.colour[i] += grey * (kGrey[i] - kHaze[i]);
    air.clear = false;
    air.layered = weather.layerTopM < WeatherDecision::kUnlimited;
    if (air.layered) air.topM = static_cast<float>(weather.layerTopM);
  }
  if (farM < double{Air::kFarthest}) {
    const double cut = std::max(farM, 1e-3);
    air.cutM = static_cast<float>(cut);
    // Nothing is left to fade at a safe cut, and what fades before it could be seen.
    const bool safe = air.layered && farM >= weather.safeFarM;
    air.fadePerM = safe ? kNoFade : static_cast<float>(1 / (kCutFade * cut));
    air.clear = false;
  }
  return air;
}

LayerRoots layerRoots(double eyeM, double topM) {
  const auto lessThan = [eyeM](double sphereM) {
    return (eyeM - sphereM) * (2 * kEarthRadiusM + eyeM + sphereM);
  };
  return {kEarthRadiusM + eyeM, lessThan(topM), lessThan(std::min(kLowestGroundM, eyeM - 1))};
}

}  // namespace trimtab::scene
