#pragma once

#include <iterator>
#include <string_view>

/// Declares the words of MATLAB's language for fis_reader.cpp and fis_writer.cpp, and what System calls them.
namespace trimtab::fuzzy_system {

inline constexpr std::string_view kFisReason = "% reason:", kFisOff = "% rule:";

/// Says how the order of a shape's numbers in MATLAB's language differs from fuzzylite's.
enum class FisOrder { same, reversed, first_is_last };
struct FisShape {
  std::string_view matlab, system;
  FisOrder order;
};
/// linzmf falls from 1 at its first number to 0 at its second: a ramp from the second to the first. The last
/// six are read and never written, because a policy has points instead of them.
inline constexpr FisShape kFisShapes[] = {{"discretemf", "Discrete", FisOrder::same},
                                          {"rampmf", "Ramp", FisOrder::same},
                                          {"linsmf", "Ramp", FisOrder::same},
                                          {"linzmf", "Ramp", FisOrder::reversed},
                                          {"trimf", "Triangle", FisOrder::same},
                                          {"trapmf", "Trapezoid", FisOrder::same},
                                          {"gaussmf", "Gaussian", FisOrder::reversed},
                                          {"gbellmf", "Bell", FisOrder::first_is_last},
                                          {"sigmf", "Sigmoid", FisOrder::reversed},
                                          {"constant", "Constant", FisOrder::same},
                                          {"linear", "Linear", FisOrder::same},
                                          {"smf", "smf", FisOrder::same},
                                          {"zmf", "zmf", FisOrder::same},
                                          {"pimf", "pimf", FisOrder::same},
                                          {"gauss2mf", "gauss2mf", FisOrder::same},
                                          {"dsigmf", "dsigmf", FisOrder::same},
                                          {"psigmf", "psigmf", FisOrder::same}};

struct FisNorm {
  std::string_view matlab, fuzzylite;
};
inline constexpr FisNorm kFisConjunctions[] = {{"min", "Minimum"}, {"prod", "AlgebraicProduct"}};
inline constexpr FisNorm kFisDisjunctions[] = {{"max", "Maximum"}, {"probor", "AlgebraicSum"}};

/// Holds what fuzzylite adds to the number of a term for the hedges before it; a minus sign says not.
struct FisHedge {
  std::string_view hedges;
  const char* code;
  double fraction;
};
inline constexpr FisHedge kFisHedges[] = {
    {"", "", 0},         {"seldom", ".01", 0.01},  {"somewhat", ".05", 0.05},
    {"very", ".2", 0.2}, {"extremely", ".3", 0.3}, {"very very", ".4", 0.4}};
inline constexpr double kFisAny = 0.99;

}  // namespace trimtab::fuzzy_system
