#include "migration.h"

#include <algorithm>
#include <cmath>

#include "trimtab/preset/json_text.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

void rename(RawParameter& parameter, std::string_view key, FindingList& notes) {
  notes.add({Severity::note, parameter.where, parameter.key, "the key " + std::string(key),
             "its former name, taken as that"});
  parameter.key = key;
}

/// Version 1 is the draft of the format: other names, and hysteresis in degrees of pitch, of which the
/// published line makes 1/60 of membership each. It was never released; its kept file keeps this path in use.
void fromVersion1(const TuningParameters&, std::vector<RawParameter>& parameters, FindingList& notes) {
  for (RawParameter& p : parameters) {
    if (p.key == "culling.method") {
      rename(p, "culling.case", notes);
    } else if (p.key == "lod.error_px") {
      rename(p, "lod.screen_space_error_px", notes);
    } else if (p.key == "fuzzy.hysteresis_deg") {
      rename(p, "fuzzy.hysteresis", notes);
      if (const auto degrees = readNumber(p.value)) p.value = numberText(*degrees / 60);
    }
  }
}

/// Says what a key of version 2 said: weight or output of the rule with these two conditions.
struct FormerRule {
  std::string_view prefix;
  AltitudeCondition altitude;
  PitchCondition pitch;
};
constexpr FormerRule kFormerRules[] = {
    {"fuzzy.rules.low_down_", AltitudeCondition::low, PitchCondition::nose_down},
    {"fuzzy.rules.low_up_", AltitudeCondition::low, PitchCondition::nose_up},
    {"fuzzy.rules.high_down_", AltitudeCondition::high, PitchCondition::nose_down},
    {"fuzzy.rules.high_up_", AltitudeCondition::high, PitchCondition::nose_up}};

/// Returns the rule with these conditions; added with what version 2 shipped if the base has lost it. It is
/// null if the list is full.
FuzzyRule* ruleLike(const FormerRule& former, RuleList& rules) {
  const auto is = [&former](const FuzzyRule& rule) {
    return rule.altitude == former.altitude && rule.pitch == former.pitch;
  };
  const auto end = rules.rule.begin() + static_cast<std::ptrdiff_t>(rules.size);
  if (const auto at = std::find_if(rules.rule.begin(), end, is); at != end) return &*at;
  if (rules.size == RuleList::kCapacity) return nullptr;
  return &(rules.rule[rules.size++] = *std::find_if(kRuleBase.rule.begin(), kRuleBase.rule.end(), is));
}

/// Version 2 had a fixed rule base: a key for the weight and one for the output of each of four rules. What a
/// file leaves out, its base decides.
void fromVersion2(const TuningParameters& base, std::vector<RawParameter>& parameters, FindingList& notes) {
  RuleList rules = base.scheme.rules;
  std::vector<RawParameter> kept;
  std::string where;
  for (RawParameter& p : parameters) {
    const auto former = std::find_if(std::begin(kFormerRules), std::end(kFormerRules),
                                     [&p](const FormerRule& f) { return p.key.starts_with(f.prefix); });
    const bool isFormer = former != std::end(kFormerRules);
    const std::string_view last = isFormer ? std::string_view(p.key).substr(former->prefix.size()) : "";
    if (last != "weight" && last != "output") {
      kept.push_back(std::move(p));
      continue;
    }
    const auto number = readNumber(p.value);
    FuzzyRule* const rule = ruleLike(*former, rules);
    if (!number || !std::isfinite(*number) || !rule) {
      notes.add({Severity::error, p.where, p.key, rule ? "a number" : "room for its rule in the base's list",
                 rule ? p.value.substr(0, 60) : std::to_string(rules.size) + " other rules"});
      continue;
    }
    (last == "weight" ? rule->weight : rule->output) = *number;
    if (where.empty()) where = p.where;
    notes.add({Severity::note, p.where, p.key, "the key fuzzy.rules",
               "a part of it by a former name, taken as rule " + conditionsText(*rule, " and ")});
  }
  if (!where.empty()) kept.push_back({"fuzzy.rules", json::valueText(*findRow("fuzzy.rules"), rules), where});
  parameters = std::move(kept);
}

/// A value of a choice that no version reads any more, and what replaces it. Versions up to 3 wrote such
/// values, and a file may still have them: they are replaced whatever the file's version.
struct WithdrawnChoice {
  std::string_view key, value, replacement;
};
constexpr WithdrawnChoice kWithdrawnChoices[] = {{"culling.occlusion", "read_back", "depth_map"}};

void replaceWithdrawn(std::vector<RawParameter>& parameters, FindingList& notes) {
  for (RawParameter& p : parameters)
    for (const WithdrawnChoice& choice : kWithdrawnChoices)
      if (p.key == choice.key && json::readString(p.value) == choice.value) {
        p.value = '"' + std::string(choice.replacement) + '"';
        notes.add({Severity::note, p.where, p.key, "a value of this version",
                   std::string(choice.value) + ", which was withdrawn; " + std::string(choice.replacement) +
                       " is used"});
      }
}

/// migrations[i] brings version i + 1 to version i + 2.
constexpr void (*kMigrations[])(const TuningParameters&, std::vector<RawParameter>&, FindingList&) = {
    fromVersion1, fromVersion2};
static_assert(std::size(kMigrations) == kPresetVersion - 1, "each older version needs its migration");

/// Says what an image generator did before a parameter existed, where the parameter's default does otherwise.
struct FormerBehaviour {
  std::string_view key, value;
};
constexpr FormerBehaviour kFormerBehaviours[] = {{"weather.precipitation_form", "effect"}};

}  // namespace

void keepFormerBehaviour(std::vector<RawParameter>& parameters, const std::string& where,
                         FindingList& notes) {
  for (const FormerBehaviour& former : kFormerBehaviours) {
    const auto has = [&](const RawParameter& p) { return p.key == former.key; };
    if (std::any_of(parameters.begin(), parameters.end(), has)) continue;
    parameters.push_back({std::string(former.key), '"' + std::string(former.value) + '"', where});
    notes.add({Severity::note, where, std::string(former.key), "every parameter in an export",
               "an export older than it; " + std::string(former.value) + " is used, as it was then"});
  }
}

void migrate(int fromVersion, const TuningParameters& base, std::vector<RawParameter>& parameters,
             FindingList& notes) {
  for (int version = fromVersion; version < kPresetVersion; ++version)
    kMigrations[version - 1](base, parameters, notes);
  replaceWithdrawn(parameters, notes);
}

}  // namespace trimtab
