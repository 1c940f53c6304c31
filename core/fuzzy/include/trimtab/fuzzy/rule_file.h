#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/result.h"

/// The rule base and its membership curves in the languages of fuzzy-logic tools. Exchanged is what
/// Combination::rules computes: inputs altitude (ft) and pitch (deg), a Takagi-Sugeno output total, the
/// weighted average of constants. Bands and hysteresis are not part of either language.
namespace trimtab {

enum class RuleFormat { fuzzylite, matlab };

/// By the file's ending, .fll or .fis.
std::optional<RuleFormat> ruleFormatOf(const std::filesystem::path& file);

/// The text of a file. Refused for readings that are not lines between points (the printed equations). Warns
/// of what a file cannot say: the rounded step's 0.5 at level flight itself, and in MATLAB's language weights
/// above 1. It cannot say either that the total is 0 where no rule fires; FuzzyLite's can. `name` becomes the
/// engine's, cut to letters, digits and _.
Result<std::string> ruleFileText(const TuningParameters& parameters, const std::string& name,
                                 RuleFormat format);

/// `onto` with the file's rules and curves, the readings and the combination that use them. Reads what
/// ruleFileText() writes and what fuzzylite makes of it: terms by straight lines (Discrete, Ramp, Triangle,
/// Trapezoid), `not` and `any`, conjunction by minimum. Anything else is refused with file, line, expected
/// and found. Warns where a curve's complement is off by rounding, up to 0.001.
Result<TuningParameters> readRuleFile(std::string_view text, const std::string& where, RuleFormat format,
                                      const TuningParameters& onto);

}  // namespace trimtab
