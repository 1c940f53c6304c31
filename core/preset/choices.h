#pragma once

#include "trimtab/preset/table.h"

/// How files spell and people read the options of each enumeration in parameters.h, in its order.
namespace trimtab::table {

/// Specialised for each enumeration, with an array `options`.
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
  static constexpr ChoiceOption options[] = {
      {"sum", "Sum"}, {"twice_minimum", "Twice the smaller"}, {"rules", "Rule base"}};
};
template <>
struct ChoicesOf<CullingCase> {
  static constexpr ChoiceOption options[] = {
      {"none", "No culling"}, {"view_frustum", "View frustum"}, {"proposed", "Proposed (adaptive)"}};
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
struct ChoicesOf<HostProtocol> {
  static constexpr ChoiceOption options[] = {
      {"auto", "Recognise"}, {"native_fdm", "FlightGear native-fdm"}, {"cigi3", "CIGI 3"}};
};

}  // namespace trimtab::table
