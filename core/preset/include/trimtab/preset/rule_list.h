#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace trimtab {

/// What a rule asks of altitude and pitch: the membership (`low`, `nose_down`), its complement to 1 (`high`,
/// `nose_up`), or nothing. `any` comes first, so that a rule that names no condition has none.
enum class AltitudeCondition { any, low, high };
enum class PitchCondition { any, nose_down, nose_up };

/// One rule of Eq. (2): it fires with the smallest of its conditions, and asks for `output` with that times
/// `weight`. A further input is a further condition, whose first value is `any`.
struct FuzzyRule {
  AltitudeCondition altitude = AltitudeCondition::any;
  PitchCondition pitch = PitchCondition::any;
  double weight = 1;  ///< lambda
  double output = 0;  ///< u, on the scale of the bands

  friend constexpr bool operator==(const FuzzyRule&, const FuzzyRule&) = default;
};

/// The rule base. Two rules may have the same conditions.
struct RuleList {
  static constexpr std::size_t kCapacity = 16;

  std::array<FuzzyRule, kCapacity> rule{};
  std::size_t size = 0;

  constexpr RuleList() = default;
  constexpr RuleList(std::initializer_list<FuzzyRule> rules) {
    std::copy(rules.begin(), rules.end(), rule.begin());
    size = rules.size();
  }
  constexpr std::span<const FuzzyRule> span() const { return {rule.data(), size}; }
  friend constexpr bool operator==(const RuleList& a, const RuleList& b) {
    if (a.size != b.size) return false;
    for (std::size_t i = 0; i < a.size; ++i)
      if (a.rule[i] != b.rule[i]) return false;
    return true;
  }
};

/// How files and explanations spell the conditions, in the enumerations' order.
inline constexpr std::array<std::string_view, 3> kAltitudeConditions{"any", "low", "high"};
inline constexpr std::array<std::string_view, 3> kPitchConditions{"any", "down", "up"};

/// "low" of AltitudeCondition::low; "?" of what is none.
std::string_view nameOf(AltitudeCondition condition);
std::string_view nameOf(PitchCondition condition);
/// "low-down", "high", "any": what the rule asks, with `joint` between.
std::string conditionsText(const FuzzyRule& rule, std::string_view joint);
/// "low&down*1=2": conditions, weight, output.
std::string ruleText(const FuzzyRule& rule);
/// The inverse; false, with `rule` unspecified, where the text is none. Numbers are finite; ranges are
/// validate()'s.
bool readRule(std::string_view text, FuzzyRule& rule);

}  // namespace trimtab
