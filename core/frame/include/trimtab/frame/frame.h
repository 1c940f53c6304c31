#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "trimtab/frame/dead_reckoning.h"
#include "trimtab/frame/motion_decision.h"
#include "trimtab/frame/policy_outcome.h"
#include "trimtab/frame/weather_decision.h"
#include "trimtab/policy/signals.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/units/geodesy.h"

/// Declares what a frame passes on, in order: state, view, cost, input, decision.
namespace trimtab {

/// The half-angles of a view that a host asks for (CIGI View Definition), degrees; left and bottom are
/// negative.
struct HostView {
  std::optional<Metres> nearDistance;
  std::optional<Degrees> left, right, bottom, top;

  friend bool operator==(const HostView&, const HostView&) = default;
};

/// Precipitation that a host asks for (CIGI Weather Control, layers 4 and 5, global scope). A state has it
/// once the host has set either layer, until the host changes it.
struct HostWeather {
  static constexpr int kMostSevere = 5;

  Precipitation precipitation = Precipitation::none;
  int severity = 0;                  ///< 0..kMostSevere
  std::optional<Metres> visibility;  ///< in that layer

  friend bool operator==(const HostWeather&, const HostWeather&) = default;
};

/// Velocity over the ground in the local horizon's axes.
struct Velocity {
  MetresPerSecond north, east, down;

  friend bool operator==(const Velocity&, const Velocity&) = default;
};

/// Says whether a host leaves an aircraft's height to the terrain (CIGI Entity Control, Ground/Ocean Clamp).
enum class GroundClamp {
  none,
  level,     ///< the height counts from the ground; pitch and roll are the host's
  conformal  ///< pitch and roll count from the slope of the ground as well
};

/// Holds what one packet, or one row of a flight, says about the aircraft.
struct AircraftState {
  double time = 0;  ///< seconds on the host's clock; the arrival time if the host sends none
  std::uint64_t packet =
      0;  ///< the host's frame number, else a running count; the same in two receivers of one host
  GeodeticPosition position;
  Attitude attitude;
  GroundClamp clamp = GroundClamp::none;  ///< a session puts such an aircraft on its terrain
  std::optional<Metres> aboveGround;      ///< from the host; the terrain's counts where it is asked and knows
  std::optional<Attitude> head;           ///< line of sight relative to the aircraft
  std::optional<Metres> visibility;       ///< of the whole atmosphere
  std::optional<HostWeather> weather;
  std::optional<Wind> wind;
  std::optional<HostView> view;
  std::optional<Knots> airspeed;     ///< calibrated; CIGI has none
  std::optional<Velocity> velocity;  ///< from the host; if unset, it is computed from successive positions
  std::optional<DeadReckoning> deadReckoning;  ///< from the host; if unset, states are extrapolated instead

  friend bool operator==(const AircraftState&, const AircraftState&) = default;
};

/// The perspective of an image: tangents of the half-angles (left and bottom are negative), size and near
/// plane.
struct ViewShape {
  int widthPx = 1280, heightPx = 720;
  double left = -0.57735, right = 0.57735, bottom = -0.32492, top = 0.32492;
  double nearM = 1;

  friend bool operator==(const ViewShape&, const ViewShape&) = default;
};

/// Returns the pixels that an angle of one radian covers at the image's centre, along the finer of the two
/// axes. Screen-space error in pixels is geometric error over distance, times this.
double pixelsPerRadian(const ViewShape& view);

/// Returns the same perspective at `scale` times the width and height, rounded to even numbers of pixels.
/// A scale that is not between 0 and 1 counts as 1, which changes nothing.
ViewShape scaledShape(ViewShape view, double scale);

/// Says which field of view an image has in a window of another shape than the preset's.
enum class ViewFit {
  preset,  ///< the preset's, so that a pixel may be wider than high
  fill     ///< that of filledShape, where the window gives the image's size (RenderSize::fit)
};

/// Returns the perspective with square pixels that fills the same width and height and contains this one: the
/// field of view grows at two opposite sides.
ViewShape filledShape(ViewShape view);

/// Returns the shape of a view from the parameters, the window's size (for RenderSize::fit) and the view that
/// the host asks for.
ViewShape viewShape(const ViewParameters& parameters, int windowWidthPx, int windowHeightPx,
                    const std::optional<HostView>& host);

/// The time of each stage of a frame, milliseconds on real clocks; NaN if a stage was not run or cannot be
/// measured. cost_stages.h says which stages sum to `total`.
struct FrameCost {
  double decide = 0, select = 0, occlusion = 0, cull = 0, draw = 0, gpu = 0, total = 0;
  double page = kNotMeasured;  ///< making and uploading what the GPU misses
  // Parts of `gpu`, and like it of a frame or two before. Without a GPU they are parts of `draw`, known only
  // if the frame waits after each pass.
  double blur = kNotMeasured, weather = kNotMeasured, symbology = kNotMeasured;

  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
};

struct FrameInput {
  AircraftState state;
  std::optional<Metres> aboveGround;  ///< for AltitudeReference::above_ground; if unset, that of `state`
  FrameCost lastCost;
  DrawnLoad drawn{};          ///< set only for MotionFrames::drawn
  SignalValues signalValues;  ///< set only if the preset has a policy
  /// Height above mean sea level that no ground exceeds; set only for AirModel::layer, if the terrain knows
  /// it.
  std::optional<Metres> highestGround{};
};

enum class Scheme { frustum, dynamic };

/// Says why a scheme and size were chosen; explain() in core/decision makes a sentence of it.
enum class SchemeReason {
  below_first_band,    ///< total under the lowest edge: view frustum alone
  in_band,             ///< the band that holds the total
  held_by_hysteresis,  ///< the total left the band by less than the hysteresis
  invalid_input,       ///< altitude or pitch is not a finite number: frustum
  altitude_unknown     ///< the preset asks for the height above ground, and neither host nor terrain knows it
};

/// Says how finely a frame looks for hidden ground, as a size in pixels: that of the depth map if one is
/// drawn, or the texels over the view from which the columns of a horizon follow.
struct OcclusionResolution {
  int widthPx = 0, heightPx = 0;
  friend bool operator==(const OcclusionResolution&, const OcclusionResolution&) = default;
};

struct FrameDecision {
  double altitudeFt = 0;  ///< the altitude that was used, by reference
  double pitchDeg = 0;
  double altitudeMembership = 0, pitchMembership = 0, totalMembership = 0;
  Scheme scheme = Scheme::frustum;
  int band = -1;  ///< index into the bands; -1 if the total is below all of them
  std::optional<OcclusionResolution> occlusionResolution;  ///< if unset, no occlusion test of any kind
  SchemeReason reason = SchemeReason::below_first_band;
  MotionDecision motion;
  WeatherDecision weather;
  PolicyOutcome policy;

  friend bool operator==(const FrameDecision&, const FrameDecision&) = default;
};

}  // namespace trimtab
