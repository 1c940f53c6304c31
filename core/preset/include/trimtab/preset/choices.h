#pragma once

#include "trimtab/preset/table.h"

/// The options of each enumeration in parameters.h, in its order: how files spell them and how people read
/// them.
namespace trimtab::table {

/// Each enumeration has a specialisation with an array `options`.
template <class E>
struct ChoicesOf;

template <>
struct ChoicesOf<AltitudeReading> {
  static constexpr ChoiceOption options[] = {{"table", "Line between points"},
                                             {"equation_a", "Equation of document A"},
                                             {"equation_b", "Equation of document B"}};
};
template <>
struct ChoicesOf<AltitudeReference> {
  static constexpr ChoiceOption options[] = {{"mean_sea_level", "Above sea level"},
                                             {"above_ground", "Above ground"}};
};
template <>
struct ChoicesOf<PitchReading> {
  static constexpr ChoiceOption options[] = {{"linear", "Line between points"},
                                             {"rounded_step", "Rounded step of Table 1"}};
};
template <>
struct ChoicesOf<Combination> {
  static constexpr ChoiceOption options[] = {{"sum", "Sum"}, {"twice_minimum", "Twice the smaller"}};
};
template <>
struct ChoicesOf<PolicyNorm> {
  static constexpr ChoiceOption options[] = {{"minimum", "Minimum, maximum"},
                                             {"product", "Product, algebraic sum"}};
};
template <>
struct ChoicesOf<CullingCase> {
  static constexpr ChoiceOption options[] = {
      {"none", "No culling"}, {"view_frustum", "View frustum"}, {"proposed", "Proposed (adaptive)"}};
};
template <>
struct ChoicesOf<OcclusionMethod> {
  static constexpr ChoiceOption options[] = {{"auto", "Automatic (horizon where it pays)"},
                                             {"horizon", "Horizon"},
                                             {"depth_map", "Depth map (published)"}};
};
template <>
struct ChoicesOf<ViewSource> {
  static constexpr ChoiceOption options[] = {{"preset", "This preset"}, {"host", "The host"}};
};
template <>
struct ChoicesOf<RenderSize> {
  static constexpr ChoiceOption options[] = {{"fit", "Fit the window"}, {"fixed", "Fixed"}};
};
template <>
struct ChoicesOf<TerrainForm> {
  static constexpr ChoiceOption options[] = {
      {"tiles", "Tiled levels"}, {"patches", "Error-bounded patches"}, {"static_trees", "Static trees"}};
};
template <>
struct ChoicesOf<StaticDistanceRule> {
  static constexpr ChoiceOption options[] = {{"picture", "Error in the picture"},
                                             {"factor", "Multiple of the error"}};
};
template <>
struct ChoicesOf<ErrorMeasure> {
  static constexpr ChoiceOption options[] = {{"rms", "Root mean square"},
                                             {"maximum", "Largest"},
                                             {"as_published", "Root mean square, as published"}};
};
template <>
struct ChoicesOf<SymbologyFrame> {
  static constexpr ChoiceOption options[] = {{"head", "The helmet"}, {"aircraft", "The aircraft"}};
};
template <>
struct ChoicesOf<SymbolColour> {
  static constexpr ChoiceOption options[] = {{"green", "Green"},   {"white", "White"},     {"amber", "Amber"},
                                             {"cyan", "Cyan"},     {"magenta", "Magenta"}, {"red", "Red"},
                                             {"yellow", "Yellow"}, {"black", "Black"}};
};
template <>
struct ChoicesOf<HostProtocol> {
  static constexpr ChoiceOption options[] = {{"auto", "Recognise"}, {"native_fdm", "FlightGear native-fdm"},
                                             {"cigi3", "CIGI 3"},   {"cigi4", "CIGI 4"},
                                             {"dis", "DIS"},        {"x_plane", "X-Plane"}};
};
template <>
struct ChoicesOf<MotionControl> {
  static constexpr ChoiceOption options[] = {
      {"off", "Off"}, {"lod_scale_and_blur", "LOD scale and blur"}, {"with_restoration", "With restoration"}};
};
template <>
struct ChoicesOf<MotionReference> {
  static constexpr ChoiceOption options[] = {{"line_of_sight", "Line of sight (aircraft and head)"},
                                             {"head", "Head against aircraft"}};
};
template <>
struct ChoicesOf<MotionFrames> {
  static constexpr ChoiceOption options[] = {{"host_states", "States of the host"},
                                             {"drawn", "Images drawn"}};
};
template <>
struct ChoicesOf<MotionDwell> {
  static constexpr ChoiceOption options[] = {{"frames", "Frames"}, {"milliseconds", "Milliseconds"}};
};
template <>
struct ChoicesOf<WeatherSource> {
  static constexpr ChoiceOption options[] = {{"preset", "This preset"}, {"host", "The host"}};
};
template <>
struct ChoicesOf<WeatherStep> {
  static constexpr ChoiceOption options[] = {
      {"clear", "Clear"},           {"rain_light", "Light rain"}, {"rain_medium", "Medium rain"},
      {"rain_heavy", "Heavy rain"}, {"snow_light", "Light snow"}, {"snow_medium", "Medium snow"},
      {"snow_heavy", "Heavy snow"}};
};
template <>
struct ChoicesOf<VisibilitySource> {
  static constexpr ChoiceOption options[] = {{"steps", "The weather step"}, {"typed", "Typed"}};
};
template <>
struct ChoicesOf<AirModel> {
  static constexpr ChoiceOption options[] = {{"uniform", "Even fog (published)"},
                                             {"layer", "Haze layer (optical range)"}};
};
template <>
struct ChoicesOf<RatioMode> {
  static constexpr ChoiceOption options[] = {
      {"off", "No cut"}, {"fixed", "Fixed ratio"}, {"adaptive", "By visibility (adaptive)"}};
};
template <>
struct ChoicesOf<PrecipitationForm> {
  static constexpr ChoiceOption options[] = {{"effect", "OpenSceneGraph's effect (published)"},
                                             {"bounded", "What an image can show (bounded cost)"}};
};

}  // namespace trimtab::table
