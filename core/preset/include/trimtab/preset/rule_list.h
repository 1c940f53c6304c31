#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace trimtab {

/// The condition of a rule on altitude or pitch: the membership (`low`, `nose_down`), its complement to 1
/// (`high`, `nose_up`), or none
/// (`any`, which comes first, so that it is the default).
enum class AltitudeCondition { any, low, high };
enum class PitchCondition { any, nose_down, nose_up };

/// One rule of Eq. (2): it fires with the smallest of its conditions' memberships, and its `output` counts
/// with that times `weight`.
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

/// The conditions as files and explanations spell them, in the enumerations' order.
inline constexpr std::array<std::string_view, 3> kAltitudeConditions{"any", "low", "high"};
inline constexpr std::array<std::string_view, 3> kPitchConditions{"any", "down", "up"};

/// Returns the name of a condition, such as "low"; "?" for a number that is none.
std::string_view nameOf(AltitudeCondition condition);
std::string_view nameOf(PitchCondition condition);
/// Returns the conditions of a rule with `joint` between them: "low-down", "high" or "any".
std::string conditionsText(const FuzzyRule& rule, std::string_view joint);
/// Returns a rule as text: conditions, weight and output, such as "low&down*1=2".
std::string ruleText(const FuzzyRule& rule);
/// Is the inverse. Returns false, with `rule` unspecified, if the text is no rule with finite numbers;
/// validate() checks ranges.
bool readRule(std::string_view text, FuzzyRule& rule);

}  // namespace trimtab
