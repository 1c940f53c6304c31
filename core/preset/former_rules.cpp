#include "former_rules.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "trimtab/preset/json_text.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

constexpr std::string_view kKey = "fuzzy.rules", kCombination = "fuzzy.combination";

/// One rule of Eq. (2): its conditions on the memberships, weight and output, as the file names them.
struct FormerRule {
  std::string altitude = "any", pitch = "any";
  double weight = 1, output = 0;
};

/// The rule base that shipped; a file of version 2 names weight and output of each.
constexpr const char* kCorners[][2] = {{"low", "down"}, {"low", "up"}, {"high", "down"}, {"high", "up"}};
std::vector<FormerRule> shippedRules() {
  constexpr double kOutputs[] = {2, 1, 0.5, 0};
  std::vector<FormerRule> rules;
  for (std::size_t i = 0; i < std::size(kCorners); ++i)
    rules.push_back({kCorners[i][0], kCorners[i][1], 1, kOutputs[i]});
  return rules;
}

bool isSound(const FormerRule& rule) {
  const auto among = [](std::string_view name, std::string_view one, std::string_view other) {
    return name == "any" || name == one || name == other;
  };
  return among(rule.altitude, "low", "high") && among(rule.pitch, "down", "up") && rule.weight >= 0 &&
         std::isfinite(rule.weight) && rule.output >= 0 && rule.output <= BandList::kTop;
}

/// Reads {"altitude": "low", "pitch": "down", "weight": 1, "output": 2}.
std::optional<FormerRule> readObject(std::string_view value) {
  FormerRule rule;
  bool hasWeight = false, hasOutput = false;
  for (const json::Member& member : json::members(value, value)) {
    const auto text = json::readString(member.value);
    const auto number = readNumber(member.value);
    if (member.key == "altitude" && text)
      rule.altitude = *text;
    else if (member.key == "pitch" && text)
      rule.pitch = *text;
    else if (member.key == "weight" && number)
      rule.weight = *number, hasWeight = true;
    else if (member.key == "output" && number)
      rule.output = *number, hasOutput = true;
    else
      return std::nullopt;
  }
  if (!hasWeight || !hasOutput || !isSound(rule)) return std::nullopt;
  return rule;
}

/// Reads "low&down*1=2".
std::optional<FormerRule> readWord(std::string_view word) {
  const std::size_t star = word.find('*'), equals = word.find('=');
  if (star == std::string_view::npos || equals == std::string_view::npos || equals < star)
    return std::nullopt;
  const auto weight = readNumber(word.substr(star + 1, equals - star - 1)),
             output = readNumber(word.substr(equals + 1));
  if (!weight || !output) return std::nullopt;
  FormerRule rule{"any", "any", *weight, *output};
  std::string_view conditions = word.substr(0, star);
  while (conditions != "any") {
    const std::size_t joint = conditions.find('&');
    const std::string name(conditions.substr(0, joint));
    (name == "low" || name == "high" ? rule.altitude : rule.pitch) = name;
    if (joint == std::string_view::npos) break;
    conditions.remove_prefix(joint + 1);
  }
  if (!isSound(rule)) return std::nullopt;
  return rule;
}

/// Reads the list of a preset, or the text that an INI export has in its place.
std::optional<std::vector<FormerRule>> readRules(std::string_view value) {
  std::vector<FormerRule> rules;
  const auto add = [&rules](const std::optional<FormerRule>& rule) {
    if (rule) rules.push_back(*rule);
    return rule.has_value();
  };
  if (const auto text = json::readString(value)) {
    std::istringstream words(*text);
    for (std::string word; words >> word;)
      if (!add(readWord(word))) return std::nullopt;
  } else {
    if (!value.starts_with('[')) return std::nullopt;
    for (const std::string_view part : json::elements(value))
      if (!json::isObject(part) || !add(readObject(part))) return std::nullopt;
  }
  return rules;
}

/// Reads weight or output of one of the four rules of version 2, from a key such as
/// fuzzy.rules.low_down_weight. Returns false if the key is none of theirs or the value is no number.
bool readCorner(const RawParameter& p, std::vector<FormerRule>& rules) {
  for (std::size_t i = 0; i < std::size(kCorners); ++i) {
    const std::string prefix = std::string(kKey) + "." + kCorners[i][0] + "_" + kCorners[i][1] + "_";
    if (!p.key.starts_with(prefix)) continue;
    const std::string_view last = std::string_view(p.key).substr(prefix.size());
    const auto number = readNumber(p.value);
    if (!number || (last != "weight" && last != "output")) return false;
    FormerRule& rule = rules[i];
    (last == "weight" ? rule.weight : rule.output) = *number;
    return isSound(rule);
  }
  return false;
}

/// Reports whether some rule fires whatever the memberships are.
bool alwaysFire(const std::vector<FormerRule>& rules) {
  return std::all_of(std::begin(kCorners), std::end(kCorners), [&rules](const auto& corner) {
    return std::any_of(rules.begin(), rules.end(), [&corner](const FormerRule& rule) {
      return rule.weight > 0 && (rule.altitude == "any" || rule.altitude == corner[0]) &&
             (rule.pitch == "any" || rule.pitch == corner[1]);
    });
  });
}

std::string conditionOf(const FormerRule& rule) {
  const std::string altitude = rule.altitude == "low"    ? "altitude_membership is low"
                               : rule.altitude == "high" ? "not altitude_membership is low"
                                                         : "";
  const std::string pitch = rule.pitch == "down" ? "pitch_membership is down"
                            : rule.pitch == "up" ? "not pitch_membership is down"
                                                 : "";
  if (altitude.empty() && pitch.empty()) return "altitude_membership is any";
  return altitude + (altitude.empty() || pitch.empty() ? "" : " and ") + pitch;
}

Policy policyFrom(const std::vector<FormerRule>& rules) {
  Policy policy;
  policy.terms = {{Signal::altitude_membership, "low", TermShape::points, {0, 0, 1, 1}},
                  {Signal::pitch_membership, "down", TermShape::points, {0, 0, 1, 1}}};
  double most = 1;
  for (const FormerRule& rule : rules) most = std::max(most, rule.weight);
  for (const FormerRule& rule : rules)
    policy.rules.push_back({.condition = conditionOf(rule),
                            .settings = {{Lever::occlusion, rule.output}},
                            .weight = rule.weight / most,
                            .enabled = true,
                            .reason = "Eq. (2)"});
  return policy;
}

RawParameter* find(std::vector<RawParameter>& parameters, std::string_view key) {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [key](const RawParameter& p) { return p.key == key; });
  return at == parameters.end() ? nullptr : &*at;
}

/// Adds lines to those that the file, or else its base, has under a key of the policy. `off` switches rules
/// off that were in a policy that was.
void addLines(std::string_view key, const TextLines& added, const TextLines& ofBase, bool off,
              const std::string& where, std::vector<RawParameter>& parameters) {
  const ParameterRow& row = *findRow(key);
  TextLines lines = ofBase;
  RawParameter* const own = find(parameters, key);
  if (own)
    if (const auto value = json::readValue(row, own->value)) lines = std::get<TextLines>(*value);
  if (off)
    for (std::string& line : lines.line)
      if (!line.starts_with("off ")) line = "off " + line;
  lines.line.insert(lines.line.end(), added.line.begin(), added.line.end());
  const std::string text = json::valueText(row, lines);
  if (own)
    own->value = text;
  else
    parameters.push_back({std::string(key), text, where});
}

}  // namespace

void replaceFormerRules(const TuningParameters& base, std::vector<RawParameter>& parameters,
                        FindingList& notes) {
  std::vector<FormerRule> rules = shippedRules();
  std::string where;
  bool refused = false;
  std::erase_if(parameters, [&](const RawParameter& p) {
    if (!p.key.starts_with(kKey)) return false;
    bool reads = p.key == kKey ? readRules(p.value).has_value() : readCorner(p, rules);
    if (p.key == kKey && reads) rules = *readRules(p.value);
    if (!reads)
      notes.add({Severity::error, p.where, p.key,
                 "rules with altitude low, high or any, pitch down, up or any, a weight of at least 0 and an "
                 "output of 0 to 2",
                 p.value.substr(0, 60)});
    refused |= !reads;
    if (where.empty()) where = p.where;
    return true;
  });
  RawParameter* const combination = find(parameters, kCombination);
  const bool used = combination && json::readString(combination->value) == "rules";
  if (refused) return;
  if (!used) {
    if (!where.empty())
      notes.add({Severity::note, where, std::string(kKey), "rules of the policy",
                 "the former rule base, which the combination did not use; it is left out"});
    return;
  }
  combination->value = "\"sum\"";
  if (where.empty()) where = combination->where;

  const RawParameter* const enabled = find(parameters, "policy.enabled");
  const bool on = enabled ? enabled->value == "true" : base.policy.enabled;
  const PolicyParameters added = policyLines(policyFrom(rules));
  addLines("policy.terms", added.terms, base.policy.terms, false, where, parameters);
  addLines("policy.rules", added.rules, base.policy.rules, !on, where, parameters);
  if (RawParameter* const own = find(parameters, "policy.enabled"))
    own->value = "true";
  else
    parameters.push_back({"policy.enabled", "true", where});
  notes.add({Severity::note, where, std::string(kKey), "rules of the policy",
             "the former rule base, taken as " + std::to_string(rules.size()) +
                 " rules of the policy that set the lever occlusion"});
  if (!alwaysFire(rules))
    notes.add({Severity::warning, where, std::string(kKey), "a rule for every altitude and pitch",
               "states in which none fires; their total was 0 and is now the sum of the memberships"});
}

}  // namespace trimtab
