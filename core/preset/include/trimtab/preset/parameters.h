#pragma once

#include "trimtab/policy/policy.h"
#include "trimtab/preset/curve.h"
#include "trimtab/preset/symbology_parameters.h"
#include "trimtab/units/quantity.h"

/// Every number that an engineer tunes. The field is the only home of its default, and its row (rows.cpp) of
/// everything else: key, label, range, help. To add a parameter, add field, row, use and test.
namespace trimtab {

/// Says how altitude becomes a membership (documents A and B, Table 1 and Eq. 1; they contradict each other).
enum class AltitudeReading { table, equation_a, equation_b };
/// Says which altitude the decision uses.
enum class AltitudeReference { mean_sea_level, above_ground };
/// Says how pitch becomes a membership: the line, or the rounded step that reproduces Table 1.
enum class PitchReading { linear, rounded_step };
/// How the two memberships become the total on the scale 0..2.
enum class Combination { sum, twice_minimum };
/// The three culling cases of documents A and B.
enum class CullingCase { none, view_frustum, proposed };
/// What looks for hidden ground if the scheme is dynamic.
enum class OcclusionMethod { automatic, horizon, depth_map };
/// Where the field of view and the near plane come from.
enum class ViewSource { preset, host };
enum class RenderSize { fit, fixed };
/// The form in which the terrain is drawn: tiles, patches, or the static trees of document E if it has them.
enum class TerrainForm { tiles, patches, static_trees };
/// Says how a tree node's error becomes its minimum viewer distance.
enum class StaticDistanceRule { picture, factor };
enum class ErrorMeasure { rms, maximum, as_published };
enum class HostProtocol { automatic, native_fdm, cigi3, cigi4, dis, x_plane };
/// The columns of document C's results: before, with the mechanism, and with LOD scale restoration.
enum class MotionControl { off, lod_scale_and_blur, with_restoration };
/// Says whose heading and pitch count: those of the view in the world, or of the head relative to the
/// aircraft.
enum class MotionReference { line_of_sight, head };
/// Says what counts as a frame of document C: a state that the host sends, or an image that is drawn.
enum class MotionFrames { host_states, drawn };
/// Says in what the length of a run of fast or slow frames is measured.
enum class MotionDwell { frames, milliseconds };
/// Says who sets precipitation and visibility.
enum class WeatherSource { preset, host };
/// Document D's densities of rain and snow.
enum class WeatherStep { clear, rain_light, rain_medium, rain_heavy, snow_light, snow_medium, snow_heavy };
/// Says whether the visibility is the step's share of the clear-day distance or a typed number.
enum class VisibilitySource { steps, typed };
/// Says what hides the distance: document D's fog, whose extinction is the same everywhere, or a layer of
/// haze under a top, whose extinction follows from the meteorological optical range.
enum class AirModel { uniform, layer };
/// Says how the far plane is set (document D, the two columns of Table 1): not at all, by one ratio for all
/// weather, or by Eq. (1). In a layer of haze the last is the safe far distance.
enum class RatioMode { off, fixed, adaptive };
/// Says how rain and snow are drawn: by osgParticle::PrecipitationEffect as document D does, or by our own
/// particles, whose cost has a bound.
enum class PrecipitationForm { effect, bounded };

// Defaults that are lists. They are constants because g++ 12 warns that a list inside a member's initialiser
// is uninitialised.
inline constexpr Curve<Feet> kAltitudeCurve{{4000, 1.0}, {5000, 0.6}, {6000, 0.3}, {7000, 0.1}, {8000, 0.0}};
inline constexpr Curve<Degrees> kPitchCurve{{-30, 1.0}, {30, 0.0}};
inline constexpr BandList kDepthMapBands{{0.1, 320, 240}, {0.5, 400, 300}, {1.0, 640, 480}, {1.5, 800, 600}};

/// CIGI counts severities from 0, the least severe, to 5. An enabled layer of severity 0 still has
/// precipitation.
inline constexpr Curve<Ratio> kSeverityDensity{{0, 0.1}, {1, 0.25}, {3, 0.5}, {5, 1.0}};

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

struct CullingParameters {
  CullingCase cullingCase = CullingCase::proposed;
  OcclusionMethod occlusion = OcclusionMethod::automatic;
  bool backFaces = true;  ///< culls nodes that face away from the eye
};

struct LodParameters {
  Pixels screenSpaceError{2};
  Ratio scale{1};  ///< 1 is full detail, larger is coarser
  /// The distances at which levels follow one another are `spreadFrom * (d / spreadFrom)^spread`, where d is
  /// the distance that the allowed error alone gives: 1 leaves them, less draws them together.
  Ratio spread{1};
  Metres spreadFrom{5000};
  bool texture = false;  ///< the ground's texture shrinks with the LOD scale too
};

/// How terrain is drawn in any form, and kept while it is flown over.
struct TerrainParameters {
  TerrainForm form = TerrainForm::tiles;
  Megabytes cache{512};
};

/// What stands on the ground.
struct ObjectParameters {
  Pixels errorPx{2};
  Pixels smallFeature{1};  ///< what is smaller in the image is not drawn
  Metres farDistance{100000};
  Pixels lightSize{0};  ///< of light points across in the image; 0 draws none, as by day
};

/// Static LOD trees (document E).
struct StaticLodParameters {
  ErrorMeasure error = ErrorMeasure::rms;
  StaticDistanceRule rule = StaticDistanceRule::picture;
  Pixels errorPx{1};             ///< used by `picture`
  Ratio distancePerError{1000};  ///< metres of distance per metre of error; used by `factor`
  /// The depth map is drawn only where at least so many triangles may be hidden.
  Ratio mapFromTriangles{30000};
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

struct WeatherParameters {
  WeatherSource source = WeatherSource::preset;
  WeatherStep step = WeatherStep::clear;
  VisibilitySource visibilityFrom = VisibilitySource::steps;
  Metres typedVisibility{10000};
  Metres clearVisibility{40000};
  bool haze = false;  ///< fog of the clear-day distance while nothing falls
  AirModel air = AirModel::uniform;
  Metres layerTop{2000};          ///< of the haze, above mean sea level; above it the air is clear
  Ratio contrastThreshold{0.02};  ///< contrast left at the visibility in AirModel::uniform
  RatioMode ratioMode = RatioMode::adaptive;
  Ratio fixedRatio{5e-5};
  Metres defaultNear{1};  ///< of Eq. (1)
  Ratio tolerance{0.05};  ///< within which calibration matches gain and loss, as a share of a clear frame
  Curve<Ratio> severityDensity = kSeverityDensity;
  PrecipitationForm precipitationForm = PrecipitationForm::bounded;
  MetresPerSecond windSpeed{0};  ///< what falls drifts with it
  Degrees windFrom{270};         ///< where it comes from, clockwise from true north
};

/// One density of rain or snow.
struct WeatherStepParameters {
  Ratio visibilityShare{1};  ///< of the clear-day distance
  Ratio density{1};          ///< particle intensity, 0..1
  Ratio farStretch{1};       ///< far plane over visibility; 1 cuts most, and calibration finds it
};

/// Says what a kind of precipitation looks like at any density.
struct PrecipitationLook {
  Ratio size{1}, fallSpeed{1};      ///< multiples of what osgParticle::PrecipitationEffect gives the density
  Ratio red{1}, green{1}, blue{1};  ///< 0..1

  friend constexpr bool operator==(const PrecipitationLook&, const PrecipitationLook&) = default;
};
/// Lighter than ground and than fog: the effect's own greys are lost before one or the other.
inline constexpr PrecipitationLook kRainLook{.red = Ratio{0.86}, .green = Ratio{0.88}, .blue = Ratio{0.91}};
inline constexpr PrecipitationLook kSnowLook{.red = Ratio{0.95}, .green = Ratio{0.96}, .blue = Ratio{0.98}};

struct HostParameters {
  HostProtocol protocol = HostProtocol::automatic;
  Ratio entity{0};                 ///< the own aircraft's number among the host's entities
  Ratio view{-1};                  ///< the view that is drawn, of those the host controls; -1: the first seen
  bool extrapolate = true;         ///< moves the eye on between packets; decisions are never extrapolated
  Milliseconds silenceAfter{500};  ///< without a packet for so long the host is silent
};

/// Head motion (document C).
struct MotionParameters {
  MotionControl control = MotionControl::with_restoration;
  MotionFrames frames = MotionFrames::host_states;
  MotionReference reference = MotionReference::line_of_sight;
  Degrees leftFov{30}, rightFov{30};  ///< of Eq. (1), not of the projection
  MotionDwell dwell = MotionDwell::frames;
  Ratio blurFrames{10};    ///< BlurStack fires at so many frames
  Ratio restoreFrames{5};  ///< LODRestoreStack fires above so many frames
  Milliseconds blurDwell{100}, restoreDwell{50};
  /// With MotionFrames::drawn, BlurStack lowers the level only while the average frame takes longer than
  /// `lodOverTime` and more than `lodOverVertices` are in view.
  Milliseconds lodOverTime{0};
  Ratio lodOverVertices{0};
  Ratio lodStep{2};
  Ratio lodMaximum{4};
  Milliseconds blurDuration{400};
  Ratio blurStrength{0.8};
  DegreesPerSecond blurFullRate{0};  ///< below this rate the blur is weaker in proportion; 0: never
  Milliseconds gap{250};
};

/// Lines of text, as the terms and rules of a policy are.
struct TextLines {
  std::vector<std::string> line;

  friend bool operator==(const TextLines&, const TextLines&) = default;
};

/// Fuzzy rules that set levers (trimtab/policy/policy.h). policy_lines.h reads the lines.
struct PolicyParameters {
  bool enabled = false;
  PolicyNorm norm = PolicyNorm::minimum;
  TextLines terms;  ///< "above_ground low = ramp 2000 1000"
  TextLines
      rules;  ///< "if above_ground is low then lod_scale = 2 with 0.5 # reason"; "off " before it if off

  friend bool operator==(const PolicyParameters&, const PolicyParameters&) = default;
};

/// The arbiter that keeps a frame's predicted work time within measure.budget_ms (trimtab/hold/arbiter.h).
struct HoldParameters {
  bool enabled = false;
  Ratio margin{0.08};      ///< the share of the budget that the prediction leaves free
  Ratio caution{1.41};     ///< how many of the model's 90 % bands stay below 1.1 of the budget
  Milliseconds calm{120};  ///< head-room must last so long before levers are restored
  Ratio lookAhead{5};      ///< the views of so many coming images are counted
  // These limit the arbiter.
  Pixels errorMaximum{16};
  Ratio renderScaleMinimum{0.5};
  Ratio particlesMinimum{0.25};
  Ratio blurMinimum{0};
  // The mean FLIP that each lever loses over its usual range, as `trimtab-cli leverage` measures it.
  Ratio lossError{0.026};
  Ratio lossRenderScale{0.022};
  Ratio lossParticles{0.011};
  Ratio lossBlur{0};
};

struct MeasureParameters {
  Milliseconds budget{16.7};  ///< the work time that a frame may take; the plots draw it as a line
};

struct TuningParameters {
  AltitudeParameters altitude;
  PitchParameters pitch;
  SchemeParameters scheme;
  CullingParameters culling;
  LodParameters lod;
  TerrainParameters terrain;
  ObjectParameters objects;
  StaticLodParameters staticLod;
  ViewParameters view;
  WeatherParameters weather;
  WeatherStepParameters rainLight{Ratio{0.5}, Ratio{0.25}};
  WeatherStepParameters rainMedium{Ratio{0.25}, Ratio{0.5}};
  WeatherStepParameters rainHeavy{Ratio{0.1}, Ratio{1}};
  WeatherStepParameters snowLight{Ratio{0.25}, Ratio{0.25}};
  WeatherStepParameters snowMedium{Ratio{0.1}, Ratio{0.5}};
  WeatherStepParameters snowHeavy{Ratio{0.04}, Ratio{1}};
  PrecipitationLook rainLook = kRainLook, snowLook = kSnowLook;
  MotionParameters motion;
  SymbologyParameters symbology;
  SymbolElement symbolPitchLadder;
  SymbolElement symbolAircraftReference;
  SymbolElement symbolFlightPath;
  SymbolElement symbolLineOfSight;
  SymbolElement symbolHeadingTape{.y = Ratio{0.78}};
  SymbolElement symbolAirspeed{.x = Ratio{-0.6}, .y = Ratio{0.1}};
  SymbolElement symbolAltitude{.x = Ratio{0.6}, .y = Ratio{0.1}};
  SymbolElement symbolHost;
  PolicyParameters policy;
  HoldParameters hold;
  HostParameters host;
  MeasureParameters measure;
};

}  // namespace trimtab
