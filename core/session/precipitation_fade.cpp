#include "trimtab/session/precipitation_fade.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab {
namespace {

constexpr double kLongestStepS = 10;

/// Returns 0 for a density that is negative or not a number.
double densityOf(const WeatherDecision& weather) {
  const bool falls = weather.precipitation != Precipitation::none && weather.density > 0;
  return falls ? std::min(weather.density, 1.0) : 0;
}

}  // namespace

void PrecipitationFade::take(const WeatherDecision& weather) {
  const double density = densityOf(weather);
  shown_ = {density > 0 ? weather.precipitation : Precipitation::none, density, density};
  settled_ = true;
}

void PrecipitationFade::advance(double time, const WeatherDecision& weather) {
  const double step = time_ ? time - *time_ : std::numeric_limits<double>::infinity();
  if (step < 0 && step >= -kLongestStepS) return;
  time_.reset();
  if (std::isfinite(time)) time_ = time;
  if (!(step >= 0 && step <= kLongestStepS)) return take(weather);

  const double density = densityOf(weather);
  const bool ends = !(density > 0) || (shown_.amount > 0 && shown_.kind != weather.precipitation);
  const double target = ends ? 0 : density;
  if (!ends) shown_.kind = weather.precipitation, shown_.density = density;
  const double change = step / kFullS;
  shown_.amount = std::clamp(target, shown_.amount - change, shown_.amount + change);
  settled_ = shown_.amount == density && (!(density > 0) || shown_.kind == weather.precipitation);
}

std::optional<FadingPrecipitation> PrecipitationFade::fading() const {
  if (settled_) return {};
  return shown_;
}

}  // namespace trimtab
