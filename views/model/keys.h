// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// The rows of the parameter table that have an editor of their own. A test looks each of them up.
namespace trimtab::views::key {

inline constexpr std::string_view kAltitudeCurve = "fuzzy.altitude.curve_ft";
inline constexpr std::string_view kAltitudeReading = "fuzzy.altitude.reading";
inline constexpr std::string_view kAltitudeReference = "fuzzy.altitude.reference";
inline constexpr std::string_view kPitchCurve = "fuzzy.pitch.curve_deg";
inline constexpr std::string_view kPitchReading = "fuzzy.pitch.reading";
inline constexpr std::string_view kBands = "fuzzy.bands_px";
inline constexpr std::string_view kHysteresis = "fuzzy.hysteresis";
inline constexpr std::string_view kCombination = "fuzzy.combination";
inline constexpr std::string_view kPolicyEnabled = "policy.enabled";
inline constexpr std::string_view kPolicyNorm = "policy.norm";
inline constexpr std::string_view kPolicyTerms = "policy.terms";
inline constexpr std::string_view kPolicyRules = "policy.rules";
inline constexpr std::string_view kBudget = "measure.budget_ms";

/// Reports whether this row has an editor of its own in a dock.
constexpr bool hasEditor(std::string_view key) {
  return key == kAltitudeCurve || key == kPitchCurve || key == kBands ||
         key == kPolicyTerms || key == kPolicyRules;
}

}  // namespace trimtab::views::key
