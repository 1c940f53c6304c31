#include "trimtab/decision/decide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "trimtab/fuzzy/bands.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/motion/head_motion.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/weather/weather.h"

namespace trimtab {
namespace {

/// Returns the nearest double to the height in feet, except that a height which is a whole number of feet
/// comes back as that number: breakpoints are whole feet, and the equation readings jump there.
double toFeet(Metres height) {
  const double feet = height.value() / unit::Foot::size;
  const double whole = std::round(feet);
  return whole * unit::Foot::size == height.value() ? whole : feet;
}

/// Writes `text` as std::snprintf does, into a string.
template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[256];
  const int length = std::snprintf(text, sizeof text, format, values...);
  return length > 0 ? std::string(text, std::min(static_cast<std::size_t>(length), sizeof text - 1))
                    : std::string();
}

std::string bandText(const BandList& bands, int band) {
  if (band < 0) return bands.size > 0 ? formatted("below %.4g", bands.band[0].low) : "no bands";
  const auto at = static_cast<std::size_t>(band);
  if (at >= bands.size) return "a band that is no more";
  const bool top = at + 1 == bands.size;
  return formatted("band [%.4g, %.4g%s", bands.band[at].low, top ? BandList::kTop : bands.band[at + 1].low,
                   top ? "]" : ")");
}

const char* combinationText(Combination combination) {
  switch (combination) {
    case Combination::sum:
      return "sum";
    case Combination::twice_minimum:
      return "twice the minimum";
  }
  return "";
}

/// Says what the policy sets: ", policy: LOD scale 2, far distance 0.8 x visible distance; height above
/// ground unknown".
std::string policyText(const PolicyOutcome& policy) {
  std::string text;
  for (const LeverRow& row : kLeverRows)
    if (policy.moves(row.lever))
      text += formatted("%s%s %.4g%s%s", text.empty() ? "; policy: " : ", ", std::string(row.label).c_str(),
                        policy[row.lever], row.unit.empty() ? "" : " ", std::string(row.unit).c_str());
  for (const SignalRow& row : kSignalRows)
    if (policy.unknownAsked >> static_cast<unsigned>(row.signal) & 1)
      text += formatted("; %s unknown", std::string(row.label).c_str());
  return text;
}

std::string outcomeText(const FrameDecision& d) {
  if (d.scheme == Scheme::frustum || !d.occlusionResolution) return "frustum, no depth map";
  return formatted("dynamic, depth map %d x %d", d.occlusionResolution->widthPx,
                   d.occlusionResolution->heightPx);
}

double totalOf(const FrameDecision& d, const TuningParameters& parameters) {
  return combine(parameters.scheme.combination, d.altitudeMembership, d.pitchMembership);
}

/// Documents A and B: the memberships and their total; nothing, with a reason, if the state does not give
/// them.
std::optional<double> decideTotal(const FrameInput& input, const ValidatedParameters& parameters,
                                  FrameDecision& decision) {
  const bool aboveGround = parameters->altitude.reference == AltitudeReference::above_ground;
  const std::optional<Metres> height = !aboveGround        ? std::optional(input.state.position.height)
                                       : input.aboveGround ? input.aboveGround
                                                           : input.state.aboveGround;
  if (!height) {
    decision.reason = SchemeReason::altitude_unknown;
    return std::nullopt;
  }
  const double altitude = toFeet(*height);
  const double pitch = input.state.attitude.pitch.value();
  if (!std::isfinite(altitude) || !std::isfinite(pitch)) {
    decision.reason = SchemeReason::invalid_input;
    return std::nullopt;
  }

  decision.altitudeFt = altitude;
  decision.pitchDeg = pitch;
  decision.altitudeMembership = altitudeMembership(parameters->altitude, altitude);
  decision.pitchMembership = pitchMembership(parameters->pitch, pitch);
  return totalOf(decision, *parameters);
}

std::optional<OcclusionResolution> resolutionOf(const BandList& bands, int band) {
  if (band < 0) return std::nullopt;
  const Band& b = bands.band[static_cast<std::size_t>(band)];
  return OcclusionResolution{b.widthPx, b.heightPx};
}

/// Documents A and B: which scheme, and how large a depth map.
void decideScheme(double total, const ValidatedParameters& parameters, DecisionMemory& memory,
                  FrameDecision& decision) {
  decision.totalMembership = total;
  const BandList& bands = parameters->scheme.bands;
  const BandChoice choice = nextBand(bands, parameters->scheme.hysteresis.value(), total, memory.band);
  memory.band = choice.band;
  setBand(decision, bands, choice.band);
  if (choice.held)
    decision.reason = SchemeReason::held_by_hysteresis;
  else
    decision.reason = choice.band >= 0 ? SchemeReason::in_band : SchemeReason::below_first_band;
}

}  // namespace

FrameDecision decide(const FrameInput& input, const ValidatedParameters& parameters, DecisionMemory& memory) {
  return decide(input, decideWeather(input.state, *parameters, input.highestGround), parameters, memory);
}

FrameDecision decide(const FrameInput& input, const WeatherDecision& weather,
                     const ValidatedParameters& parameters, DecisionMemory& memory) {
  // Made in place: copying what was just written in smaller pieces takes the processor longer than deciding
  // it.
  FrameDecision decision{.occlusionResolution = {},
                         .motion = decideMotion(input.state, parameters->motion, memory.motion, input.drawn),
                         .weather = weather,
                         .policy = {}};
  const std::optional<double> total = decideTotal(input, parameters, decision);
  const CompiledPolicy* const policy = parameters.policy();
  // A rule that sets the occlusion replaces the total.
  if (total && !(policy && policy->moves(Lever::occlusion)))
    decideScheme(*total, parameters, memory, decision);
  if (policy) followPolicy(input.state.time, input.signalValues, parameters, memory, decision);
  return decision;
}

void followPolicy(double timeS, SignalValues flight, const ValidatedParameters& parameters,
                  DecisionMemory& memory, FrameDecision& decision) {
  const CompiledPolicy& policy = *parameters.policy();
  thread_local PolicyDecision fired;  // kept, so that a decision allocates nothing
  const bool known =
      decision.reason != SchemeReason::invalid_input && decision.reason != SchemeReason::altitude_unknown;
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  flight[Signal::altitude_membership] = known ? decision.altitudeMembership : kUnknown;
  flight[Signal::pitch_membership] = known ? decision.pitchMembership : kUnknown;
  policy.decide(flight, fired);
  LeverValues neutral;
  for (const LeverRow& row : kLeverRows) neutral[row.lever] = row.neutral;
  // What the occlusion rests at where no rule sets it.
  neutral[Lever::occlusion] = known ? totalOf(decision, *parameters) : 0;
  neutral[Lever::screen_space_error] = parameters->lod.screenSpaceError.value();
  neutral[Lever::lod_scale] = parameters->lod.scale.value();
  neutral[Lever::object_error] = parameters->objects.errorPx.value();
  neutral[Lever::small_feature] = parameters->objects.smallFeature.value();
  neutral[Lever::object_distance] = parameters->objects.farDistance.value();
  decision.policy = {memory.levers.follow(timeS, fired.target, neutral).value, policy.levers(),
                     fired.unknownAsked};
  if (known && policy.moves(Lever::occlusion))
    decideScheme(decision.policy[Lever::occlusion], parameters, memory, decision);
}

void setBand(FrameDecision& decision, const BandList& bands, int band) {
  decision.band = band;
  decision.scheme = band < 0 ? Scheme::frustum : Scheme::dynamic;
  decision.occlusionResolution = resolutionOf(bands, band);
}

LeverChain leversOf(const FrameDecision& d, const TuningParameters& parameters) {
  // The memberships alone, without the hysteresis, are looked up only where a rule replaced what they ask
  // for.
  std::optional<OcclusionResolution> unruled = d.occlusionResolution;
  if (d.policy.moves(Lever::occlusion)) {
    const BandList& bands = parameters.scheme.bands;
    unruled = resolutionOf(bands, bandOf(bands, totalOf(d, parameters)));
  }
  LeverChain chain;
  chain.preset = presetLevers(parameters, unruled);
  chain.motion = withMotion(chain.preset, d.motion);
  chain.weather = withWeather(chain.motion, d.weather);
  chain.policy = withPolicy(chain.weather, d.policy, d.motion, d.occlusionResolution);
  chain.drawn = chain.policy;
  return chain;
}

FrameLevers askedLevers(const FrameDecision& d, const TuningParameters& parameters) {
  // What the memberships ask for counts only where no rule replaced it, and there it is the decision's.
  const FrameLevers preset = presetLevers(parameters, d.occlusionResolution);
  return withPolicy(withWeather(withMotion(preset, d.motion), d.weather), d.policy, d.motion,
                    d.occlusionResolution);
}

LeverChain leversIn(const WeatherDecision& weather, FrameDecision decision,
                    const TuningParameters& parameters) {
  decision.weather = weather;
  decision.policy.moved &= ~(1u << indexOf(Lever::far_distance));
  return leversOf(decision, parameters);
}

std::string explain(const FrameDecision& d, const ValidatedParameters& parameters) {
  const bool aboveGround = parameters->altitude.reference == AltitudeReference::above_ground;
  if (d.reason == SchemeReason::invalid_input)
    return outcomeText(d) + ": the altitude or the pitch is not a number";
  if (d.reason == SchemeReason::altitude_unknown)
    return outcomeText(d) + ": the height above ground is not known";

  std::string text =
      outcomeText(d) +
      formatted(": %.0f ft%s gives %.3f, pitch %.2f deg gives %.3f, %s %.3f", d.altitudeFt,
                aboveGround ? " above ground" : "", d.altitudeMembership, d.pitchDeg, d.pitchMembership,
                d.policy.moves(Lever::occlusion) ? "policy" : combinationText(parameters->scheme.combination),
                d.totalMembership);
  const std::string band = bandText(parameters->scheme.bands, d.band);
  switch (d.reason) {
    case SchemeReason::below_first_band:
      text += ", " + band;
      break;
    case SchemeReason::in_band:
      text += ", in " + band;
      break;
    case SchemeReason::held_by_hysteresis:
      text += formatted(", held %s%s by hysteresis %.4g", d.band >= 0 ? "in " : "", band.c_str(),
                        parameters->scheme.hysteresis.value());
      break;
    case SchemeReason::invalid_input:
    case SchemeReason::altitude_unknown:
      break;
  }
  return text + policyText(d.policy);
}

}  // namespace trimtab
