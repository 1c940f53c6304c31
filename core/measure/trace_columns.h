#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include "trace_chain.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/measure/trace.h"
#include "trimtab/motion/head_motion.h"

/// The trace's columns: the one list that header, writer and reader share. A column that a later version adds
/// is `Cell::optional`, so that traces without it stay readable: its field keeps its default.
namespace trimtab::trace {

/// Holds what a policy was given, what its levers were before, and what it set. The cells of a preset without
/// a policy are empty, and so is the cell of a signal that nobody knows.
struct FlatPolicy {
  std::array<std::optional<double>, kSignals> signals;
  std::array<std::optional<double>, kLevers> before, levers;
  std::optional<double> timeBefore;
  std::optional<std::uint32_t> movingBefore, moved, unknownAsked;
};

/// The eye of an image that is decided between two states. Its cells are empty otherwise.
struct FlatEye {
  std::optional<double> timeS;
  std::optional<Degrees> latitude, longitude;
  std::optional<Metres> height;
  std::optional<Degrees> pitch, roll, heading, headPitch, headRoll, headHeading;
};

/// A row as a flat list of cells. Groups that may be absent as a whole have a flag that their first cell
/// decides.
struct Flat {
  TraceRow row;
  Metres height;
  Feet altitude;  ///< for people and other programs; `height` is the number that counts
  std::optional<double> headHeading, headPitch, headRoll;
  std::optional<MetresPerSecond> north, east, down;
  HostView view;
  std::optional<Precipitation> precipitation;
  std::optional<int> severity;
  std::optional<Metres> layerVisibility;
  std::optional<int> depthMapWidth, depthMapHeight;
  FlatPolicy policy;
  FlatEye drawnEye;
  FlatChain chain;
  TraceFrame frame;
  bool hasFrame = false;
  HoldDecision hold;
  bool hasHold = false;
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Head motion as it was before the decision.
template <class Memory, class Visit>
void forEachMotionMemory(Memory& m, const Visit& visit) {
  visit("motion_known_before", Cell::optional, m.known);
  visit("motion_time_before_s", Cell::optional, m.timeS);
  visit("motion_heading_before_deg", Cell::optional, m.headingDeg);
  visit("motion_pitch_before_deg", Cell::optional, m.pitchDeg);
  visit("blur_stack_before", Cell::optional, m.blurStack.frames);
  visit("blur_stack_before_ms", Cell::optional, m.blurStack.ms);
  visit("blur_stack_before_deg", Cell::optional, m.blurStack.variationDeg);
  visit("restore_stack_before", Cell::optional, m.restoreStack.frames);
  visit("restore_stack_before_ms", Cell::optional, m.restoreStack.ms);
  visit("restore_stack_before_deg", Cell::optional, m.restoreStack.variationDeg);
  visit("motion_level_before", Cell::optional, m.level);
  visit("blur_remaining_before_ms", Cell::optional, m.blurRemainingMs);
  visit("blur_share_before", Cell::optional, m.blurShare);
}

template <class Decision, class Visit>
void forEachMotionColumn(Decision& m, const Visit& visit) {
  visit("motion_reason", Cell::optional, m.reason);
  visit("motion_fast", Cell::optional, m.fast);
  visit("motion_rate_degps", Cell::optional, m.rateDegPerS);
  visit("motion_threshold_degps", Cell::optional, m.thresholdDegPerS);
  visit("blur_stack", Cell::optional, m.blurStack.frames);
  visit("blur_stack_ms", Cell::optional, m.blurStack.ms);
  visit("blur_stack_deg", Cell::optional, m.blurStack.variationDeg);
  visit("blur_limit", Cell::optional, m.blurLimit);
  visit("restore_stack", Cell::optional, m.restoreStack.frames);
  visit("restore_stack_ms", Cell::optional, m.restoreStack.ms);
  visit("restore_stack_deg", Cell::optional, m.restoreStack.variationDeg);
  visit("restore_limit", Cell::optional, m.restoreLimit);
  visit("motion_limits_in_ms", Cell::optional, m.limitsInMs);
  visit("motion_level", Cell::optional, m.level);
  visit("motion_lod_scale", Cell::optional, m.lodScale);
  visit("blur_strength", Cell::optional, m.blur.strength);
  visit("blur_remaining_ms", Cell::optional, m.blur.remainingMs);
}

template <class Decision, class Visit>
void forEachWeatherColumn(Decision& w, const Visit& visit) {
  visit("weather_precipitation", Cell::optional, w.precipitation);
  visit("weather_density", Cell::optional, w.density);
  visit("weather_fogged", Cell::optional, w.fogged);
  visit("weather_visibility_m", Cell::optional, w.visibilityM);
  visit("weather_extinction_per_m", Cell::optional, w.extinctionPerM);
  visit("weather_layer_top_m", Cell::optional, w.layerTopM);
  visit("weather_safe_far_m", Cell::optional, w.safeFarM);
  visit("weather_near_far_ratio", Cell::optional, w.nearFarRatio);
  visit("weather_far_m", Cell::optional, w.farM);
  visit("weather_reason", Cell::optional, w.reason);
  visit("weather_far_reason", Cell::optional, w.farReason);
}

/// The columns of a policy: a name for each signal and lever.
struct PolicyColumns {
  std::array<std::string, kSignals> signals;
  std::array<std::string, kLevers> before, levers;
};
inline const PolicyColumns& policyColumns() {
  static const PolicyColumns columns = [] {
    PolicyColumns c;
    for (const SignalRow& row : kSignalRows)
      c.signals[indexOf(row.signal)] = "signal_" + std::string(row.key);
    for (const LeverRow& row : kLeverRows) {
      c.levers[indexOf(row.lever)] = "lever_" + std::string(row.key);
      c.before[indexOf(row.lever)] = c.levers[indexOf(row.lever)] + "_before";
    }
    return c;
  }();
  return columns;
}

template <class Policy, class Visit>
void forEachPolicyInput(Policy& p, const Visit& visit) {
  const PolicyColumns& columns = policyColumns();
  for (std::size_t s = 0; s < kSignals; ++s) visit(columns.signals[s].c_str(), Cell::optional, p.signals[s]);
  for (std::size_t l = 0; l < kLevers; ++l) visit(columns.before[l].c_str(), Cell::optional, p.before[l]);
  visit("levers_time_before_s", Cell::optional, p.timeBefore);
  visit("levers_moving_before", Cell::optional, p.movingBefore);
}

template <class Policy, class Visit>
void forEachPolicyColumn(Policy& p, const Visit& visit) {
  const PolicyColumns& columns = policyColumns();
  for (std::size_t l = 0; l < kLevers; ++l) visit(columns.levers[l].c_str(), Cell::optional, p.levers[l]);
  visit("levers_set", Cell::optional, p.moved);
  visit("signals_unknown", Cell::optional, p.unknownAsked);
}

/// Visits what the arbiter of the budget decided for the image that showed the decision. Former traces also
/// have hold_given and hold_before, what it decided from and its memory: no column of that name is known any
/// more, so they are ignored whatever is in them.
template <class Decision, class Visit>
void forEachHoldColumn(Decision& d, const Visit& visit) {
  visit("hold_reason", Cell::hold, d.reason);
  visit("hold_asked_error_px", Cell::hold, d.asked.errorPx);
  visit("hold_asked_render_scale", Cell::hold, d.asked.renderScale);
  visit("hold_asked_particles", Cell::hold, d.asked.particleShare);
  visit("hold_asked_blur", Cell::hold, d.asked.blurShare);
  visit("hold_error_px", Cell::hold, d.held.errorPx);
  visit("hold_render_scale", Cell::hold, d.held.renderScale);
  visit("hold_particles", Cell::hold, d.held.particleShare);
  visit("hold_blur", Cell::hold, d.held.blurShare);
  visit("hold_asked_ground_ms", Cell::hold, d.askedMs.ground);
  visit("hold_asked_weather_ms", Cell::hold, d.askedMs.weather);
  visit("hold_asked_blur_ms", Cell::hold, d.askedMs.blur);
  visit("hold_asked_other_ms", Cell::hold, d.askedMs.other);
  visit("hold_ground_ms", Cell::hold, d.heldMs.ground);
  visit("hold_weather_ms", Cell::hold, d.heldMs.weather);
  visit("hold_blur_ms", Cell::hold, d.heldMs.blur);
  visit("hold_other_ms", Cell::hold, d.heldMs.other);
  visit("hold_limit_ms", Cell::hold, d.limitMs);
  visit("hold_band_ms", Cell::hold, d.halfBandMs);
}

/// Visits the eye of an image that is decided between two states.
template <class Eye, class Visit>
void forEachDrawnEye(Eye& eye, const Visit& visit) {
  visit("drawn_time_s", Cell::optional, eye.timeS);
  visit("drawn_latitude_deg", Cell::optional, eye.latitude);
  visit("drawn_longitude_deg", Cell::optional, eye.longitude);
  visit("drawn_height_m", Cell::optional, eye.height);
  visit("drawn_pitch_deg", Cell::optional, eye.pitch);
  visit("drawn_roll_deg", Cell::optional, eye.roll);
  visit("drawn_heading_deg", Cell::optional, eye.heading);
  visit("drawn_head_pitch_deg", Cell::optional, eye.headPitch);
  visit("drawn_head_roll_deg", Cell::optional, eye.headRoll);
  visit("drawn_head_heading_deg", Cell::optional, eye.headHeading);
}

/// Calls `visit(name, cell, value)` for each column in the file's order: the one list that header, writer
/// and reader share.
template <class F, class Visit>
void forEachColumn(F& f, const Visit& visit) {
  auto& state = f.row.input.state;
  visit("time_s", Cell::required, state.time);
  visit("latitude_deg", Cell::required, state.position.latitude);
  visit("longitude_deg", Cell::required, state.position.longitude);
  visit("altitude_ft", Cell::optional, f.altitude);
  visit("pitch_deg", Cell::required, state.attitude.pitch);
  visit("roll_deg", Cell::required, state.attitude.roll);
  visit("heading_deg", Cell::required, state.attitude.heading);
  visit("head_heading_deg", Cell::optional, f.headHeading);
  visit("head_pitch_deg", Cell::optional, f.headPitch);

  visit("packet", Cell::required, state.packet);
  visit("height_m", Cell::required, f.height);
  visit("above_ground_m", Cell::optional, f.row.input.aboveGround);
  visit("highest_ground_m", Cell::optional, f.row.input.highestGround);
  visit("head_roll_deg", Cell::optional, f.headRoll);
  visit("visibility_m", Cell::optional, state.visibility);
  visit("airspeed_kt", Cell::optional, state.airspeed);
  visit("velocity_north_mps", Cell::optional, f.north);
  visit("velocity_east_mps", Cell::optional, f.east);
  visit("velocity_down_mps", Cell::optional, f.down);
  visit("precipitation", Cell::optional, f.precipitation);
  visit("precipitation_severity", Cell::optional, f.severity);
  visit("precipitation_visibility_m", Cell::optional, f.layerVisibility);
  visit("view_near_m", Cell::optional, f.view.nearDistance);
  visit("view_left_deg", Cell::optional, f.view.left);
  visit("view_right_deg", Cell::optional, f.view.right);
  visit("view_bottom_deg", Cell::optional, f.view.bottom);
  visit("view_top_deg", Cell::optional, f.view.top);
  visit("band_before", Cell::optional, f.row.before.band);
  forEachMotionMemory(f.row.before.motion, visit);
  auto& last = f.row.input.lastCost;
  for (const CostStage& stage : kCostStages) visit(stage.lastColumn, Cell::optional, last.*stage.ms);
  visit("drawn_fps", Cell::optional, f.row.input.drawn.framesPerS);
  visit("drawn_vertices", Cell::optional, f.row.input.drawn.vertices);
  forEachDrawnEye(f.drawnEye, visit);
  forEachPolicyInput(f.policy, visit);

  auto& d = f.row.decision;
  visit("decision_altitude_ft", Cell::required, d.altitudeFt);
  visit("decision_pitch_deg", Cell::required, d.pitchDeg);
  visit("altitude_membership", Cell::required, d.altitudeMembership);
  visit("pitch_membership", Cell::required, d.pitchMembership);
  visit("total_membership", Cell::required, d.totalMembership);
  visit("scheme", Cell::required, d.scheme);
  visit("band", Cell::required, d.band);
  visit("depth_map_width_px", Cell::optional, f.depthMapWidth);
  visit("depth_map_height_px", Cell::optional, f.depthMapHeight);
  visit("reason", Cell::required, d.reason);
  visit("lod_scale", Cell::required, f.row.levers.policy.lodScale);
  forEachMotionColumn(d.motion, visit);
  forEachWeatherColumn(d.weather, visit);
  forEachPolicyColumn(f.policy, visit);
  forEachHoldColumn(f.hold, visit);
  forEachChainColumn(f.chain, visit);

  visit("triangles", Cell::frame, f.frame.counts.triangles);
  visit("vertices", Cell::frame, f.frame.counts.vertices);
  visit("tiles_drawn", Cell::frame, f.frame.counts.tilesDrawn);
  visit("culled_frustum", Cell::frame, f.frame.counts.culledFrustum);
  visit("culled_occluded", Cell::frame, f.frame.counts.culledOccluded);
  visit("culled_beyond_visibility", Cell::frame, f.frame.counts.culledBeyondVisibility);
  visit("culled_back_facing", Cell::frame, f.frame.counts.culledBackFacing);
  visit("objects_drawn", Cell::frame, f.frame.counts.objectsDrawn);
  visit("objects_occluded", Cell::frame, f.frame.counts.objectsOccluded);
  auto& cost = f.frame.cost;
  for (const CostStage& stage : kCostStages) visit(stage.column, Cell::frame, cost.*stage.ms);
}

inline FlatPolicy flattenPolicy(const TraceRow& row) {
  FlatPolicy p;
  for (std::size_t s = 0; s < kSignals; ++s)
    if (const double value = row.input.signalValues.value[s]; !std::isnan(value)) p.signals[s] = value;
  if (const LeverDrive::State& before = row.before.levers.state(); before.begun) {
    for (std::size_t l = 0; l < kLevers; ++l) p.before[l] = before.values.value[l];
    p.timeBefore = before.timeS;
    p.movingBefore = before.moving;
  }
  if (const PolicyOutcome& set = row.decision.policy; set != PolicyOutcome{}) {
    for (std::size_t l = 0; l < kLevers; ++l) p.levers[l] = set.value[l];
    p.moved = set.moved;
    p.unknownAsked = set.unknownAsked;
  }
  return p;
}

inline void unflattenPolicy(const FlatPolicy& p, TraceRow& row) {
  for (std::size_t s = 0; s < kSignals; ++s)
    if (p.signals[s]) row.input.signalValues.value[s] = *p.signals[s];
  if (p.timeBefore) {
    LeverDrive::State before{.timeS = *p.timeBefore, .begun = true};
    before.moving = p.movingBefore.value_or(0);
    for (std::size_t l = 0; l < kLevers; ++l) before.values.value[l] = p.before[l].value_or(0);
    row.before.levers = LeverDrive(before);
  }
  PolicyOutcome& set = row.decision.policy;
  for (std::size_t l = 0; l < kLevers; ++l) set.value[l] = p.levers[l].value_or(0);
  set.moved = p.moved.value_or(0);
  set.unknownAsked = p.unknownAsked.value_or(0);
}

inline FlatEye flattenEye(const DrawnEye& eye) {
  FlatEye f{eye.timeS,
            eye.position.latitude,
            eye.position.longitude,
            eye.position.height,
            eye.attitude.pitch,
            eye.attitude.roll,
            eye.attitude.heading,
            {},
            {},
            {}};
  if (eye.head) {
    f.headPitch = eye.head->pitch;
    f.headRoll = eye.head->roll;
    f.headHeading = eye.head->heading;
  }
  return f;
}

inline std::optional<DrawnEye> unflattenEye(const FlatEye& f) {
  if (!f.timeS) return std::nullopt;
  DrawnEye eye{*f.timeS, {}, {}, {}};
  eye.position = {f.latitude.value_or(Degrees{}), f.longitude.value_or(Degrees{}),
                  f.height.value_or(Metres{})};
  eye.attitude = {f.heading.value_or(Degrees{}), f.pitch.value_or(Degrees{}), f.roll.value_or(Degrees{})};
  if (f.headHeading)
    eye.head = Attitude{*f.headHeading, f.headPitch.value_or(Degrees{}), f.headRoll.value_or(Degrees{})};
  return eye;
}

inline Flat flatten(const TraceRow& row) {
  Flat f;
  f.row = row;
  f.chain = flattenChain(row.levers);
  if (row.input.drawn.eye) f.drawnEye = flattenEye(*row.input.drawn.eye);
  f.policy = flattenPolicy(row);
  const AircraftState& state = row.input.state;
  f.height = state.position.height;
  f.altitude = Feet{f.height.value() / unit::Foot::size};
  if (!f.row.input.aboveGround) f.row.input.aboveGround = state.aboveGround;
  if (state.head) {
    f.headHeading = state.head->heading.value();
    f.headPitch = state.head->pitch.value();
    f.headRoll = state.head->roll.value();
  }
  if (state.view) f.view = *state.view;
  if (state.velocity) {
    f.north = state.velocity->north;
    f.east = state.velocity->east;
    f.down = state.velocity->down;
  }
  if (state.weather) {
    f.precipitation = state.weather->precipitation;
    f.severity = state.weather->severity;
    f.layerVisibility = state.weather->visibility;
  }
  if (row.decision.occlusionResolution) {
    f.depthMapWidth = row.decision.occlusionResolution->widthPx;
    f.depthMapHeight = row.decision.occlusionResolution->heightPx;
  }
  f.hasFrame = row.frame.has_value();
  if (row.frame) f.frame = *row.frame;
  f.hasHold = row.hold.has_value();
  if (row.hold) f.hold = *row.hold;
  return f;
}

inline TraceRow unflatten(Flat& f) {
  f.row.input.drawn.eye = unflattenEye(f.drawnEye);
  unflattenChain(f.chain, f.row.levers);
  AircraftState& state = f.row.input.state;
  state.position.height = f.height;
  state.aboveGround = f.row.input.aboveGround;
  if (f.headHeading || f.headPitch || f.headRoll)
    state.head = Attitude{Degrees{f.headHeading.value_or(0)}, Degrees{f.headPitch.value_or(0)},
                          Degrees{f.headRoll.value_or(0)}};
  if (f.view != HostView{}) state.view = f.view;
  if (f.north && f.east && f.down) state.velocity = Velocity{*f.north, *f.east, *f.down};
  if (f.precipitation)
    state.weather = HostWeather{*f.precipitation, f.severity.value_or(0), f.layerVisibility};
  if (f.depthMapWidth && f.depthMapHeight)
    f.row.decision.occlusionResolution = OcclusionResolution{*f.depthMapWidth, *f.depthMapHeight};
  unflattenPolicy(f.policy, f.row);
  if (f.hasFrame) f.row.frame = f.frame;
  if (f.hasHold) f.row.hold = f.hold;
  return f.row;
}

}  // namespace trimtab::trace
