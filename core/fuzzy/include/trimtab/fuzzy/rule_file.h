#pragma once

#include <string>
#include <string_view>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/units/result.h"

/// Exchanges the rule base and its membership curves with fuzzy-logic tools: what Combination::rules
/// computes, with the inputs altitude (ft) and pitch (deg) and a Takagi-Sugeno output total, the weighted
/// average of constants. Bands and hysteresis are not part of either language.
namespace trimtab {

/// Returns the text of a file. Fails for readings that are not lines between points (the printed equations).
/// Warns about what the file cannot express: the rounded step's 0.5 at level flight itself and, in MATLAB's
/// language, weights above 1. MATLAB's language cannot express either that the total is 0 if no rule fires;
/// FuzzyLite's can. `name`, reduced to letters, digits and _, becomes the engine's.
Result<std::string> ruleFileText(const TuningParameters& parameters, const std::string& name,
                                 RuleFormat format);

/// Returns `onto` with the file's rules and curves, and with the readings and the combination that use them.
/// Reads what ruleFileText() writes and what fuzzylite makes of that: terms of straight lines (Discrete,
/// Ramp, Triangle, Trapezoid), `not` and `any`, conjunction by minimum. It refuses anything else with file,
/// line, expected and found. Warns if a curve's complement is off by rounding, up to 0.001.
Result<TuningParameters> readRuleFile(std::string_view text, const std::string& where, RuleFormat format,
                                      const TuningParameters& onto);

}  // namespace trimtab
