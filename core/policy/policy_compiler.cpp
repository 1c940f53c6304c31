#include <algorithm>

#include "condition.h"
#include "membership_at.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/number.h"

namespace trimtab {

class PolicyCompiler {
 public:
  PolicyCompiler(const Policy& policy, const std::string& where) : policy_(policy), where_(where) {}

  Result<CompiledPolicy> run() {
    limit("terms", policy_.terms.size(), kMostPolicyTerms);
    limit("rules", policy_.rules.size(), kMostPolicyRules);
    if (!findings_.empty()) return findings_;
    out_.norm_ = policy_.norm;
    for (const PolicyTerm& term : policy_.terms) addTerm(term);
    for (std::size_t i = 0; i < policy_.rules.size(); ++i)
      addRule(policy_.rules[i], "rules." + std::to_string(i + 1));
    addSettings();
    if (!findings_.empty()) return findings_;
    return std::move(out_);
  }

 private:
  void refuse(std::string key, std::string expected, std::string found) {
    findings_.push_back({Severity::error, where_, std::move(key), std::move(expected),
                         found.empty() ? "nothing" : found.substr(0, 80)});
  }
  void limit(const char* key, std::size_t count, std::size_t most) {
    if (count > most) refuse(key, "at most " + std::to_string(most), std::to_string(count));
  }

  std::optional<std::size_t> findTerm(Signal signal, std::string_view name) const {
    for (std::size_t i = 0; i < out_.terms_.size(); ++i)
      if (policy_.terms[i].signal == signal && policy_.terms[i].name == name) return i;
    return std::nullopt;
  }

  void addTerm(const PolicyTerm& term) {
    const std::string key = "terms." + std::string(rowOf(term.signal).key) + "." + term.name.substr(0, 40);
    if (!isTermName(term.name))
      refuse(key, "a name of at most 40 letters, digits and _ that is no word of rules", term.name);
    if (findTerm(term.signal, term.name)) refuse(key, "a name that stands once", term.name);
    if (const auto flaw = flawOf(term)) refuse(key, flaw->expected, flaw->found);
    const std::size_t count = std::min(term.numbers.size(), kMostTermNumbers);
    out_.terms_.push_back({term.shape, static_cast<std::uint8_t>(term.signal),
                           static_cast<std::uint16_t>(count),
                           static_cast<std::uint32_t>(out_.numbers_.size())});
    out_.numbers_.insert(out_.numbers_.end(), term.numbers.begin(),
                         term.numbers.begin() + static_cast<std::ptrdiff_t>(count));
  }

  void addRule(const PolicyRule& rule, const std::string& key) {
    CompiledPolicy::Rule made{};
    made.firstStep = static_cast<std::uint32_t>(out_.steps_.size());
    made.weight = rule.enabled ? rule.weight : 0;
    const auto steps = readCondition(rule.condition, where_, key);
    if (steps)
      for (const ConditionStep& step : *steps) addStep(step, key, made);
    else
      findings_.insert(findings_.end(), steps.findings().begin(), steps.findings().end());
    made.steps = static_cast<std::uint32_t>(out_.steps_.size()) - made.firstStep;
    if (!(rule.weight >= 0 && rule.weight <= 1)) refuse(key, "a weight from 0 to 1", numberText(rule.weight));
    if (rule.settings.empty()) refuse(key, "at least one lever", "");
    std::uint32_t set = 0;
    for (const LeverSetting& setting : rule.settings) {
      const LeverRow& row = rowOf(setting.lever);
      const std::uint32_t bit = 1u << static_cast<unsigned>(setting.lever);
      if (set & bit) refuse(key, "each lever once", std::string(row.key));
      set |= bit;
      if (!(setting.value >= row.hard.low && setting.value <= row.hard.high))
        refuse(
            key,
            std::string(row.key) + " from " + numberText(row.hard.low) + " to " + numberText(row.hard.high),
            numberText(setting.value));
    }
    if (made.weight > 0) out_.levers_ |= set;
    if (made.weight > 0) out_.signals_ |= made.asked;
    out_.rules_.push_back(made);
  }

  void addSettings() {
    for (std::size_t l = 0; l < kLevers; ++l) {
      for (std::size_t r = 0; r < policy_.rules.size(); ++r)
        for (const LeverSetting& setting : policy_.rules[r].settings)
          if (static_cast<std::size_t>(setting.lever) == l)
            out_.settings_.push_back({static_cast<std::uint32_t>(r), setting.value});
      out_.firstSetting_[l + 1] = static_cast<std::uint32_t>(out_.settings_.size());
    }
  }

  void addStep(const ConditionStep& step, const std::string& key, CompiledPolicy::Rule& rule) {
    using Op = CompiledPolicy::Op;
    constexpr Op kOps[] = {Op::push, Op::both,     Op::either,    Op::invert,
                           Op::very, Op::somewhat, Op::extremely, Op::seldom};
    const bool both = step.kind == ConditionStep::Kind::both;
    if (step.kind != ConditionStep::Kind::proposition) {
      // With a term right before it, a connective needs no stack.
      if ((both || step.kind == ConditionStep::Kind::either) && out_.steps_.back().op == Op::push)
        out_.steps_.back().op = both ? Op::both_term : Op::either_term;
      else
        out_.steps_.push_back({kOps[static_cast<std::size_t>(step.kind)], 0});
      return;
    }
    std::size_t term = policy_.terms.size();
    if (step.term != "any") {
      const auto found = findTerm(step.signal, step.term);
      if (!found) refuse(key, termsOf(step.signal), std::string(step.term));
      term = found.value_or(term);
      rule.asked |= 1u << static_cast<unsigned>(step.signal);
    }
    const bool first = out_.steps_.size() == rule.firstStep;
    out_.steps_.push_back({first ? Op::first : Op::push, static_cast<std::uint16_t>(term)});
  }

  std::string termsOf(Signal signal) const {
    std::string names;
    for (const PolicyTerm& term : policy_.terms)
      if (term.signal == signal) names += (names.empty() ? ": " : ", ") + term.name;
    return "a term of " + std::string(rowOf(signal).key) + (names.empty() ? ", which has none" : names);
  }

  const Policy& policy_;
  const std::string& where_;
  CompiledPolicy out_;
  Findings findings_;
};

Result<CompiledPolicy> compile(const Policy& policy, const std::string& where) {
  return PolicyCompiler(policy, where).run();
}

}  // namespace trimtab
