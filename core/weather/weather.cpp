#include "trimtab/weather/weather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "trimtab/fuzzy/membership.h"
#include "trimtab/weather/haze_layer.h"

namespace trimtab {
namespace {

/// A fog can be drawn for these visibilities, metres; they are the same as the rows' range.
constexpr double kNearestVisibility = 10, kFarthestVisibility = 1e6;

constexpr std::array<WeatherStepParameters TuningParameters::*, 6> kGroups{
    &TuningParameters::rainLight, &TuningParameters::rainMedium, &TuningParameters::rainHeavy,
    &TuningParameters::snowLight, &TuningParameters::snowMedium, &TuningParameters::snowHeavy};

/// Light, medium and heavy of one kind.
std::array<WeatherStepParameters, 3> stepsOf(const TuningParameters& p, Precipitation kind) {
  if (kind == Precipitation::snow) return {p.snowLight, p.snowMedium, p.snowHeavy};
  return {p.rainLight, p.rainMedium, p.rainHeavy};
}

bool usable(const std::optional<Metres>& visibility) {
  return visibility && visibility->value() > 0;
}

/// Returns the nearer of what a host says of the atmosphere and of the layer that falls; 0 if it says nothing
/// usable.
double hostVisibilityM(const AircraftState& state) {
  const std::optional<Metres> none;
  const auto& layer =
      state.weather && state.weather->precipitation != Precipitation::none ? state.weather->visibility : none;
  if (usable(state.visibility) && usable(layer)) return std::min(state.visibility->value(), layer->value());
  if (usable(state.visibility)) return state.visibility->value();
  return usable(layer) ? layer->value() : 0;
}

bool saysSomethingInvalid(const AircraftState& state) {
  const auto& layer = state.weather ? state.weather->visibility : std::nullopt;
  return (state.visibility && !usable(state.visibility)) || (layer && !usable(layer));
}

void setVisibility(WeatherDecision& d, const WeatherParameters& p, double visibilityM) {
  const bool layer = p.air == AirModel::layer;
  d.visibilityM = visibilityM;
  d.extinctionPerM = extinction(visibilityM, layer ? kOpticalRangeContrast : p.contrastThreshold.value());
  d.fogged = d.extinctionPerM > 0;
  if (layer && d.fogged) d.layerTopM = p.layerTop.value();
}

bool isLayer(const WeatherDecision& d) {
  return d.layerTopM < WeatherDecision::kUnlimited;
}

/// Sets the adaptive ratio in a layer of haze: nothing that can be seen is cut, and a calibration may push
/// the far plane out from there.
void setSafeFarPlane(WeatherDecision& d, const WeatherParameters& p, double stretch) {
  const double pushedM = stretch > 1 ? d.visibilityM * stretch : 0;
  d.farM = std::max(d.safeFarM, pushedM);
  d.nearFarRatio = p.defaultNear.value() / d.farM;
  d.farReason = std::isinf(d.farM)     ? FarReason::unbounded
                : pushedM > d.safeFarM ? FarReason::stretched
                                       : FarReason::safe;
}

/// Clear weather by the preset: no fog unless haze is wanted.
void setClear(WeatherDecision& d, const TuningParameters& p) {
  if (!p.weather.haze) return;
  d.reason = WeatherReason::haze;
  setVisibility(d, p.weather, p.weather.clearVisibility.value());
}

double decidePreset(WeatherDecision& d, const TuningParameters& p) {
  const WeatherStepParameters* step = stepParameters(p, p.weather.step);
  const bool typed = p.weather.visibilityFrom == VisibilitySource::typed;
  if (step != nullptr) {
    d.precipitation = precipitationOf(p.weather.step);
    d.density = step->density.value();
  }
  if (step == nullptr && !typed) {
    setClear(d, p);
    return 1;
  }
  d.reason = typed ? WeatherReason::typed : WeatherReason::step;
  setVisibility(d, p.weather, stepVisibilityM(p, p.weather.step));
  return step != nullptr ? step->farStretch.value() : 1;
}

double decideHost(WeatherDecision& d, const AircraftState& state, const TuningParameters& p) {
  WeatherStepParameters like;
  if (state.weather && state.weather->precipitation != Precipitation::none) {
    const double severity = std::clamp(state.weather->severity, 0, HostWeather::kMostSevere);
    d.precipitation = state.weather->precipitation;
    d.density = curveValue(p.weather.severityDensity, severity);
    like = stepParametersAt(p, d.precipitation, d.density);
  }
  const bool falls = d.density > 0;
  const double said = hostVisibilityM(state);
  const bool invalid = said == 0 && saysSomethingInvalid(state);
  if (said > 0) {
    d.reason = WeatherReason::host;
    const double drawn = std::isinf(said) ? said : std::clamp(said, kNearestVisibility, kFarthestVisibility);
    if (drawn != said) d.reason = WeatherReason::visibility_limited;
    setVisibility(d, p.weather, drawn);
  } else if (falls) {
    d.reason = WeatherReason::host;
    setVisibility(d, p.weather, p.weather.clearVisibility.value() * like.visibilityShare.value());
  } else {
    setClear(d, p);
    if (state.weather && d.reason == WeatherReason::clear) d.reason = WeatherReason::host;
  }
  if (invalid) d.reason = WeatherReason::invalid_visibility;
  return like.farStretch.value();
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  const int length = std::snprintf(text, sizeof text, format, values...);
  return length > 0 ? std::string(text, std::min(static_cast<std::size_t>(length), sizeof text - 1))
                    : std::string();
}

std::string_view sentence(WeatherReason reason) {
  switch (reason) {
    case WeatherReason::clear:
      return "clear weather of this preset";
    case WeatherReason::haze:
      return "clear weather of this preset, with its clear-day haze";
    case WeatherReason::step:
      return "this preset's weather";
    case WeatherReason::typed:
      return "this preset's weather with the typed visibility";
    case WeatherReason::host:
      return "as the host says";
    case WeatherReason::host_said_nothing:
      return "the host has not spoken of weather: this preset's";
    case WeatherReason::invalid_visibility:
      return "the host's visibility is no distance: this preset's";
    case WeatherReason::visibility_limited:
      return "the host's visibility, as near or far as can be drawn";
  }
  return "";
}

std::string_view sentence(FarReason reason) {
  switch (reason) {
    case FarReason::off:
      return "cut switched off";
    case FarReason::clear:
      return "clear weather is not cut";
    case FarReason::fixed:
      return "fixed ratio";
    case FarReason::visible:
      return "at the visibility";
    case FarReason::stretched:
      return "pushed out until gain and loss match";
    case FarReason::safe:
      return "where nothing can be seen any more";
    case FarReason::unbounded:
      return "something may be seen at any distance";
  }
  return "";
}

}  // namespace

double extinction(double visibilityM, double contrastThreshold) {
  return std::isfinite(visibilityM) ? -std::log(contrastThreshold) / visibilityM : 0;
}

Precipitation precipitationOf(WeatherStep step) {
  if (step == WeatherStep::clear) return Precipitation::none;
  return step < WeatherStep::snow_light ? Precipitation::rain : Precipitation::snow;
}

const WeatherStepParameters* stepParameters(const TuningParameters& parameters, WeatherStep step) {
  if (step == WeatherStep::clear) return nullptr;
  return &(parameters.*kGroups[static_cast<std::size_t>(step) - 1]);
}
WeatherStepParameters* stepParameters(TuningParameters& parameters, WeatherStep step) {
  if (step == WeatherStep::clear) return nullptr;
  return &(parameters.*kGroups[static_cast<std::size_t>(step) - 1]);
}

double stepVisibilityM(const TuningParameters& parameters, WeatherStep step) {
  const WeatherParameters& p = parameters.weather;
  if (p.visibilityFrom == VisibilitySource::typed) return p.typedVisibility.value();
  const WeatherStepParameters* group = stepParameters(parameters, step);
  return p.clearVisibility.value() * (group != nullptr ? group->visibilityShare.value() : 1);
}

WeatherStepParameters stepParametersAt(const TuningParameters& parameters, Precipitation precipitation,
                                       double density) {
  WeatherStepParameters below;
  below.density = Ratio{0};
  if (precipitation == Precipitation::none || !(density > 0)) return below;
  // If two steps have one density, the later one counts, as on a curve. A step that is less dense than the
  // one before it is passed over.
  for (const WeatherStepParameters& step : stepsOf(parameters, precipitation)) {
    const double from = below.density.value(), to = step.density.value();
    if (density < to) {
      const double part = (density - from) / (to - from);
      const auto between = [part](Ratio a, Ratio b) { return a + (b - a) * part; };
      return {between(below.visibilityShare, step.visibilityShare), Ratio{density},
              between(below.farStretch, step.farStretch)};
    }
    if (to >= from) below = step;
  }
  below.density = Ratio{density};
  return below;
}

void setFarPlane(WeatherDecision& d, const WeatherParameters& p, double stretch) {
  d.nearFarRatio = 0;
  d.farM = WeatherDecision::kUnlimited;
  if (p.ratioMode == RatioMode::off) {
    d.farReason = FarReason::off;
    return;
  }
  const double near = p.defaultNear.value();
  if (p.ratioMode == RatioMode::fixed) {
    d.farReason = FarReason::fixed;
    d.nearFarRatio = p.fixedRatio.value();
  } else if (!d.fogged) {
    d.farReason = FarReason::clear;
    return;
  } else if (isLayer(d)) {
    setSafeFarPlane(d, p, stretch);
    return;
  } else {
    d.farReason = stretch > 1 ? FarReason::stretched : FarReason::visible;
    d.nearFarRatio = near / (d.visibilityM * std::max(stretch, 1.0));
  }
  d.farM = near / d.nearFarRatio;
}

WeatherDecision decideWeather(const AircraftState& state, const TuningParameters& parameters,
                              std::optional<Metres> highestGround) {
  WeatherDecision decision;
  double stretch = 1;
  if (parameters.weather.source == WeatherSource::preset) {
    stretch = decidePreset(decision, parameters);
  } else if (!state.weather && !state.visibility) {
    stretch = decidePreset(decision, parameters);
    decision.reason = WeatherReason::host_said_nothing;
  } else {
    stretch = decideHost(decision, state, parameters);
  }
  if (decision.precipitation == Precipitation::none || decision.density <= 0) {
    decision.precipitation = Precipitation::none;
    decision.density = 0;
  }
  if (isLayer(decision))
    decision.safeFarM = safeFarM(decision.extinctionPerM, decision.layerTopM, state.position.height.value(),
                                 highestGround ? highestGround->value() : kHighestGroundM);
  setFarPlane(decision, parameters.weather, stretch);
  return decision;
}

Wind windOf(const AircraftState& state, const WeatherParameters& parameters) {
  if (parameters.source == WeatherSource::host && state.wind) return *state.wind;
  return {parameters.windSpeed, parameters.windFrom, {}};
}

std::string explain(const WeatherDecision& d) {
  std::string text =
      d.precipitation == Precipitation::none
          ? std::string("nothing falls")
          : formatted("%s of density %.3g", std::string(toText(d.precipitation)).c_str(), d.density);
  text += d.fogged ? formatted(", visibility %.0f m", d.visibilityM) : ", no fog";
  if (isLayer(d)) text += formatted(" in haze up to %.0f m", d.layerTopM);
  text += ": " + std::string(sentence(d.reason));
  if (std::isfinite(d.farM))
    text += formatted("; far plane at %.0f m, ratio %.3g: ", d.farM, d.nearFarRatio);
  else
    text += "; no far plane: ";
  return text + std::string(sentence(d.farReason));
}

}  // namespace trimtab
