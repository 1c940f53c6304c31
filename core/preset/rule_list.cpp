#include "trimtab/preset/rule_list.h"

#include <cmath>
#include <optional>

#include "trimtab/units/number.h"

namespace trimtab {

namespace {

template <class Condition>
std::string_view nameIn(const std::array<std::string_view, 3>& names, Condition condition) {
  const auto index = static_cast<std::size_t>(condition);
  return index < names.size() ? names[index] : "?";
}

/// Reads `name` as one of the conditions; each input may be asked about once.
bool addCondition(std::string_view name, FuzzyRule& rule) {
  const auto at = [name](const std::array<std::string_view, 3>& names) {
    return static_cast<std::size_t>(std::find(names.begin() + 1, names.end(), name) - names.begin());
  };
  if (const std::size_t i = at(kAltitudeConditions); i < kAltitudeConditions.size()) {
    if (rule.altitude != AltitudeCondition::any) return false;
    rule.altitude = static_cast<AltitudeCondition>(i);
    return true;
  }
  if (const std::size_t i = at(kPitchConditions); i < kPitchConditions.size()) {
    if (rule.pitch != PitchCondition::any) return false;
    rule.pitch = static_cast<PitchCondition>(i);
    return true;
  }
  return false;
}

}  // namespace

std::string_view nameOf(AltitudeCondition condition) {
  return nameIn(kAltitudeConditions, condition);
}
std::string_view nameOf(PitchCondition condition) {
  return nameIn(kPitchConditions, condition);
}

std::string conditionsText(const FuzzyRule& rule, std::string_view joint) {
  std::string text;
  if (rule.altitude != AltitudeCondition::any) text = nameOf(rule.altitude);
  if (rule.pitch != PitchCondition::any)
    text.append(text.empty() ? std::string_view{} : joint).append(nameOf(rule.pitch));
  return text.empty() ? "any" : text;
}

std::string ruleText(const FuzzyRule& rule) {
  return conditionsText(rule, "&") + "*" + numberText(rule.weight) + "=" + numberText(rule.output);
}

bool readRule(std::string_view text, FuzzyRule& rule) {
  const std::size_t star = text.find('*'), equals = text.find('=');
  if (star == std::string_view::npos || equals == std::string_view::npos || equals < star) return false;
  const auto weight = readNumber(text.substr(star + 1, equals - star - 1)),
             output = readNumber(text.substr(equals + 1));
  if (!weight || !output || !std::isfinite(*weight) || !std::isfinite(*output)) return false;
  rule = {AltitudeCondition::any, PitchCondition::any, *weight, *output};
  std::string_view conditions = text.substr(0, star);
  if (conditions == "any") return true;
  for (;;) {
    const std::size_t joint = conditions.find('&');
    if (!addCondition(conditions.substr(0, joint), rule)) return false;
    if (joint == std::string_view::npos) return true;
    conditions.remove_prefix(joint + 1);
  }
}

}  // namespace trimtab
