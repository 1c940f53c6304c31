#include "trimtab/policy/policy_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "condition.h"
#include "fuzzy_shapes.h"
#include "mapped_system.h"
#include "order_zero.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/rule_file.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"
#include "words.h"

namespace trimtab {
namespace {

using fuzzy_system::kFormerOutput;
using fuzzy_system::leverOfOutput;
using fuzzy_system::System;

struct Norms {
  std::string_view conjunction, disjunction;
};
constexpr Norms kMinimum{"Minimum", "Maximum"}, kProduct{"AlgebraicProduct", "AlgebraicSum"};

// --- From a policy ---

/// Each signal that has terms or that a rule names, as `any` may be asked of a signal without terms.
void addInputs(const Policy& policy, System& system) {
  for (const SignalRow& row : kSignalRows) {
    fuzzy_system::Variable input{std::string(row.key), row.range, true, {}, "", {}, ""};
    for (const PolicyTerm& term : policy.terms) {
      if (term.signal != row.signal) continue;
      input.terms.push_back(
          {term.name, std::string(fuzzy_system::systemNameOf(term.shape)), term.numbers, ""});
      if (term.shape == TermShape::points) fuzzy_system::moveStepsApart(input.terms.back().numbers);
    }
    const bool named = std::any_of(policy.rules.begin(), policy.rules.end(), [&row](const PolicyRule& rule) {
      const auto words = policyWords(rule.condition);
      return std::find(words.begin(), words.end(), row.key) != words.end();
    });
    if (named || !input.terms.empty()) system.inputs.push_back(std::move(input));
  }
}

/// Each lever that a rule sets; the distinct values that rules give it are its terms v1, v2 ..., rising.
void addOutputs(const Policy& policy, System& system) {
  for (const LeverRow& row : kLeverRows) {
    std::vector<double> values;
    for (const PolicyRule& rule : policy.rules)
      for (const LeverSetting& setting : rule.settings)
        if (setting.lever == row.lever) values.push_back(setting.value);
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    fuzzy_system::Variable output;
    output.name = row.key;
    output.range = row.hard;
    for (std::size_t i = 0; i < values.size(); ++i)
      output.terms.push_back({"v" + std::to_string(i + 1), "Constant", {values[i]}, ""});
    system.outputs.push_back(std::move(output));
  }
}

fuzzy_system::Rule ruleOf(const PolicyRule& rule, const System& system) {
  // compile() has read it, so that it can be read.
  fuzzy_system::Rule made{withSingleTermsNegated(*readCondition(rule.condition, "", "")),
                          {},
                          rule.weight,
                          rule.enabled,
                          rule.reason,
                          ""};
  for (const LeverSetting& setting : rule.settings) {
    const std::size_t output = fuzzy_system::indexOf(system.outputs, rowOf(setting.lever).key);
    const auto& terms = system.outputs[output].terms;
    const auto term = std::find_if(terms.begin(), terms.end(), [&](const fuzzy_system::Term& each) {
      return each.numbers[0] == setting.value;
    });
    made.conclusions.push_back({output, static_cast<std::size_t>(term - terms.begin())});
  }
  return made;
}

// --- To a policy ---

class Translation {
 public:
  /// Takes a system whose variables are named by keys.
  Translation(System system, const std::string& where) : system_(std::move(system)), where_(where) {}

  Result<Policy> run() {
    for (const fuzzy_system::Variable& input : system_.inputs) addTerms(input);
    for (const fuzzy_system::Variable& output : system_.outputs) checkOutput(output);
    setNorm();
    if (findings_.empty())
      for (const fuzzy_system::Rule& rule : system_.rules) addRule(rule);
    if (policy_.rules.empty() && findings_.empty())
      refuse(where_, "rule", "at least one rule; if the file had some, it is cut: write it again", "none");
    if (!findings_.empty()) return firstOf(findings_, where_);
    const auto compiled = compile(policy_, where_);
    if (compiled) return std::move(policy_);
    findings_ = firstOf(compiled.findings(), where_);
    for (Finding& f : findings_) f.where = placeOf(f.key);
    return findings_;
  }

 private:
  void refuse(std::string where, std::string key, std::string expected, std::string found) {
    findings_.push_back(
        {Severity::error, std::move(where), std::move(key), std::move(expected), found.substr(0, 80)});
  }

  void addTerms(const fuzzy_system::Variable& input) {
    const auto signal = signalNamed(input.name);
    const Range range = rowOf(*signal).range;
    if (input.lockRange && (input.range.low != range.low || input.range.high != range.high))
      refuse(input.where, "input " + input.name,
             "the range " + numberText(range.low) + " " + numberText(range.high) + ", or lock-range: false",
             numberText(input.range.low) + " " + numberText(input.range.high));
    for (const fuzzy_system::Term& term : input.terms) {
      const auto shape = fuzzy_system::policyShapeOf(term);
      if (!shape) {
        refuse(term.where, "term " + term.name.substr(0, 40), "a shape that a policy has", term.shape);
        continue;
      }
      policy_.terms.push_back({*signal, term.name, *shape, term.numbers});
      if (policy_.terms.back().shape == TermShape::points)
        fuzzy_system::moveStepsTogether(policy_.terms.back().numbers);
      termPlaces_.push_back(term.where);
    }
  }

  void checkOutput(const fuzzy_system::Variable& output) {
    if (!std::isnan(output.unfired) && !(output.name == kFormerOutput && output.unfired == 0))
      refuse(
          output.unfiredWhere, "default",
          "nan: a lever that no rule sets is neutral; write nan, or add a rule for what the default was for",
          numberText(output.unfired));
    for (const fuzzy_system::Term& term : output.terms)
      if (term.shape != "Constant" || term.numbers.size() != 1)
        refuse(term.where, "term " + term.name.substr(0, 40), "Constant with one number",
               term.shape + " of " + std::to_string(term.numbers.size()) + " numbers");
  }

  /// Takes the norms of the words that the rules say, since files name both of them in any case.
  void setNorm() {
    const auto said = [this](std::string_view word) {
      return std::any_of(system_.rules.begin(), system_.rules.end(), [&](const fuzzy_system::Rule& rule) {
        const auto words = policyWords(rule.condition);
        return std::find(words.begin(), words.end(), word) != words.end();
      });
    };
    const auto& both = system_.conjunction;
    const auto& either = system_.disjunction;
    const bool andSaid = said("and"), orSaid = said("or");
    const auto isNone = [](const fuzzy_system::Setting& norm) {
      return norm.value.empty() || norm.value == "none";
    };
    const bool byOr = !andSaid && (orSaid || isNone(both));
    policy_.norm = (byOr ? either.value == kProduct.disjunction : both.value == kProduct.conjunction)
                       ? PolicyNorm::product
                       : PolicyNorm::minimum;
    const Norms norms = policy_.norm == PolicyNorm::product ? kProduct : kMinimum;
    const auto check = [&](const fuzzy_system::Setting& norm, const char* key, std::string_view wanted) {
      if (norm.value != wanted)
        refuse(norm.where, key,
               "Minimum with Maximum, or AlgebraicProduct with AlgebraicSum (min with max, prod with probor)",
               norm.value);
    };
    const bool strange =
        !isNone(both) && both.value != kMinimum.conjunction && both.value != kProduct.conjunction;
    if (andSaid || strange) check(both, "conjunction", norms.conjunction);
    if (orSaid) check(either, "disjunction", norms.disjunction);
  }

  void addRule(const fuzzy_system::Rule& rule) {
    PolicyRule made{rule.condition, {}, rule.weight, rule.enabled, rule.reason};
    if (rule.weight > 1)
      refuse(rule.where, "weight",
             "a weight from 0 to 1; divide all weights of the file by the greatest, which leaves weighted "
             "averages as they are",
             numberText(rule.weight));
    for (const fuzzy_system::Conclusion& conclusion : rule.conclusions) {
      const auto& output = system_.outputs[conclusion.output];
      const fuzzy_system::Term& term = output.terms[conclusion.term];
      const Lever lever = *leverOfOutput(output.name);
      checkValue(conclusion, rowOf(lever));
      made.settings.push_back({lever, term.numbers[0]});
    }
    policy_.rules.push_back(std::move(made));
  }

  /// Refuses values beyond the lever's range once for each output, since one mapping mends them all.
  void checkValue(const fuzzy_system::Conclusion& conclusion, const LeverRow& row) {
    const fuzzy_system::Term& term = system_.outputs[conclusion.output].terms[conclusion.term];
    const double value = term.numbers[0];
    if ((value >= row.hard.low && value <= row.hard.high) || !beyond_.insert(conclusion.output).second)
      return;
    refuse(term.where, "term " + term.name.substr(0, 40),
           std::string(row.key) + " from " + numberText(row.hard.low) + " to " + numberText(row.hard.high) +
               ", or --map \"OUTPUT=" + std::string(row.key) + "*SCALE+OFFSET\"",
           numberText(value));
  }

  /// Returns the line of what compile() names "terms.SIGNAL.NAME" or "rules.N".
  std::string placeOf(const std::string& key) const {
    constexpr std::string_view kRules = "rules.";
    if (key.starts_with(kRules))
      return system_.rules[static_cast<std::size_t>(std::stoul(key.substr(kRules.size()))) - 1].where;
    for (std::size_t i = 0; i < policy_.terms.size(); ++i) {
      const PolicyTerm& term = policy_.terms[i];
      if (key == "terms." + std::string(rowOf(term.signal).key) + "." + term.name.substr(0, 40))
        return termPlaces_[i];
    }
    return where_;
  }

  const System system_;
  const std::string& where_;
  Policy policy_;
  std::set<std::size_t> beyond_;  ///< outputs
  std::vector<std::string> termPlaces_;
  Findings findings_;
};

}  // namespace

Result<std::string> policyFileText(const Policy& policy, const std::string& name, RuleFormat format) {
  if (const auto compiled = compile(policy, name); !compiled) return compiled.findings();
  const Norms norms = policy.norm == PolicyNorm::product ? kProduct : kMinimum;
  System system;
  system.name = fuzzy_system::engineName(name, "policy");
  system.conjunction.value = norms.conjunction;
  system.disjunction.value = norms.disjunction;
  addInputs(policy, system);
  addOutputs(policy, system);
  for (const PolicyRule& rule : policy.rules) system.rules.push_back(ruleOf(rule, system));
  auto text = fuzzy_system::systemText(system, format);
  // De Morgan's laws lengthen a condition, so it may be longer than what can be read.
  Findings findings = text ? readPolicyFile(*text, name, format).findings() : text.findings();
  if (!hasError(findings)) return text;
  for (Finding& f : findings) f.where = name;
  return findings;
}

Result<Policy> readPolicyFile(std::string_view text, const std::string& where, RuleFormat format,
                              const RuleFileOptions& options) {
  const auto file = RuleFile::open(text, where, format);
  return file ? file->policy(options.mapping, options.acceptDifference) : file.findings();
}

struct RuleFile::State {
  std::string where;
  System system;
  Findings notes;  ///< of reading it
  std::vector<Variable> inputs, outputs;
  /// With constants for its outputs, the second if any difference is accepted; unset until asked for.
  std::array<std::optional<Result<System>>, 2> constant;

  const Result<System>& withConstants(bool accept) {
    auto& made = constant[accept];
    if (!made) made = fuzzy_system::orderZeroOf(system, where, accept);
    return *made;
  }
};

Result<RuleFile> RuleFile::open(std::string_view text, const std::string& where, RuleFormat format) {
  auto read = fuzzy_system::readSystem(text, where, format);
  if (!read) return read.findings();
  auto state = std::make_shared<State>();
  state->where = where;
  state->system = std::move(*read);
  state->notes = read.findings();
  for (const auto& input : state->system.inputs)
    state->inputs.push_back({input.name, input.range, fuzzy_system::keyInName(input.name, true)});
  for (const auto& output : state->system.outputs)
    state->outputs.push_back({output.name, output.range, fuzzy_system::keyInName(output.name, false)});
  return RuleFile(std::move(state));
}

const std::vector<RuleFile::Variable>& RuleFile::inputs() const {
  return state_->inputs;
}

const std::vector<RuleFile::Variable>& RuleFile::outputs() const {
  return state_->outputs;
}

const Findings& RuleFile::differences(bool acceptDifference) const {
  return state_->withConstants(acceptDifference).findings();
}

bool RuleFile::acceptMatters() const {
  return mappingMayHelp(differences(false));
}

Result<Policy> RuleFile::policy(std::span<const RuleVariable> mapping, bool acceptDifference) const {
  const auto keys = fuzzy_system::keysOf(state_->system, mapping, state_->where);
  if (!keys) return keys.findings();
  const auto& system = state_->withConstants(acceptDifference);
  if (!system) return system.findings();
  auto policy = Translation(fuzzy_system::mappedBy(*keys, *system), state_->where).run();
  if (!policy) return policy;
  Findings notes = state_->notes;
  for (const Findings* more : {&keys.findings(), &system.findings()})
    notes.insert(notes.end(), more->begin(), more->end());
  return {std::move(*policy), std::move(notes)};
}

bool mappingMayHelp(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    const auto names = [&finding](std::string_view option) {
      return finding.expected.find(option) != std::string::npos ||
             finding.found.find(option) != std::string::npos;
    };
    return names("--map ") || names("--accept-difference");
  });
}

}  // namespace trimtab
