#pragma once

#include "trimtab/preset/curve.h"
#include "trimtab/units/quantity.h"

/// Every number an engineer tunes. A field here is the only home of its default; its row in rows.cpp is the
/// only home of everything else (key, label, range, help). Adding a parameter: field, row, use, test.
namespace trimtab {

/// How altitude becomes a membership (documents A and B, Table 1 and Eq. 1; they contradict each other).
enum class AltitudeReading { table, equation_a, equation_b };
/// Which altitude feeds the decision.
enum class AltitudeReference { mean_sea_level, above_ground };
/// How pitch becomes a membership: the line, or the rounded step that reproduces Table 1.
enum class PitchReading { linear, rounded_step };
/// How the two memberships become the total on the scale 0..2.
enum class Combination { sum, twice_minimum, rules };
/// The papers' three culling cases.
enum class CullingCase { none, view_frustum, proposed };
/// Where field of view and near plane come from.
enum class ViewSource { preset, host };
enum class RenderSize { fit, fixed };
enum class HostProtocol { automatic, native_fdm, cigi3 };

// Defaults that are lists. As constants, because g++ 12 takes a list inside a member's initialiser for
// uninitialised.
inline constexpr Curve<Feet> kAltitudeCurve{{4000, 1.0}, {5000, 0.6}, {6000, 0.3}, {7000, 0.1}, {8000, 0.0}};
inline constexpr Curve<Degrees> kPitchCurve{{-30, 1.0}, {30, 0.0}};
inline constexpr BandList kDepthMapBands{{0.1, 320, 240}, {0.5, 400, 300}, {1.0, 640, 480}, {1.5, 800, 600}};

struct AltitudeParameters {
  AltitudeReading reading = AltitudeReading::table;
  AltitudeReference reference = AltitudeReference::mean_sea_level;
  Curve<Feet> curve = kAltitudeCurve;
  Feet maximum{8000};                 ///< h_max of the equations
  Feet heightOffset{10};              ///< h_offset of the equations
  Membership membershipOffset{1e-6};  ///< x_offset of the equations
};

struct PitchParameters {
  PitchReading reading = PitchReading::linear;
  Curve<Degrees> curve = kPitchCurve;  ///< used by `linear`
  Membership step{0.017};              ///< per degree; used by `rounded_step`
  Degrees limit{30};                   ///< used by `rounded_step`
};

struct SchemeParameters {
  Combination combination = Combination::sum;
  Membership hysteresis{0.05};
  BandList bands = kDepthMapBands;
};

/// The shipped rule base of Eq. (2): weight lambda and singleton output u (0..2) of four rules. "low" is the
/// altitude membership, "high" its complement; "down" is the pitch membership, "up" its complement.
struct RuleParameters {
  Ratio lowDownWeight{1}, lowUpWeight{1}, highDownWeight{1}, highUpWeight{1};
  Membership lowDownOutput{2.0}, lowUpOutput{1.0}, highDownOutput{0.5}, highUpOutput{0.0};
};

struct CullingParameters {
  CullingCase method = CullingCase::proposed;
};

struct LodParameters {
  Pixels screenSpaceError{2};
  Ratio scale{1};  ///< 1 is full detail, larger is coarser
};

struct ViewParameters {
  ViewSource source = ViewSource::preset;
  Degrees horizontalFov{60};
  Degrees verticalFov{36};
  Metres nearDistance{1};
  RenderSize renderSize = RenderSize::fit;
  Pixels width{1280};  ///< used by `fixed`
  Pixels height{720};
};

struct HostParameters {
  HostProtocol protocol = HostProtocol::automatic;
  bool extrapolate = true;         ///< move the eye between packets; decisions never are
  Milliseconds silenceAfter{500};  ///< no packet for so long: the host is silent
};

struct MeasureParameters {
  Milliseconds budget{16.7};  ///< a frame's work time that the plots draw as a line
};

struct TuningParameters {
  AltitudeParameters altitude;
  PitchParameters pitch;
  SchemeParameters scheme;
  RuleParameters rules;
  CullingParameters culling;
  LodParameters lod;
  ViewParameters view;
  HostParameters host;
  MeasureParameters measure;
};

}  // namespace trimtab
