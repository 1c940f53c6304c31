#include <algorithm>
#include <numeric>

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
    arrangeParts();
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
    const std::size_t partsBefore = parts_.size();
    const auto steps = readCondition(rule.condition, where_, key);
    if (steps)
      addCondition(*steps, key, made);
    else
      findings_.insert(findings_.end(), steps.findings().begin(), steps.findings().end());
    if (rule.enabled && rule.weight > 0) {
      made.weight = rule.weight;
    } else {
      made = {};
      made.condition = any();
      parts_.resize(partsBefore);
    }
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

  /// A part of a condition whose place among the others is not known yet.
  struct Part {
    CompiledPolicy::Op op;
    std::uint32_t level;  ///< above those of its operands
    std::uint32_t a, b;   ///< terms, any(), and from there on parts in the order of parts_
  };

  std::uint32_t any() const { return static_cast<std::uint32_t>(policy_.terms.size()); }
  std::uint32_t levelOf(std::uint32_t value) const {
    return value <= any() ? 0 : parts_[value - any() - 1].level;
  }

  void addCondition(std::span<const ConditionStep> steps, const std::string& key,
                    CompiledPolicy::Rule& rule) {
    using Op = CompiledPolicy::Op;
    constexpr Op kOps[] = {Op::both,     Op::either,    Op::invert, Op::very,
                           Op::somewhat, Op::extremely, Op::seldom};
    constexpr auto kFirst = static_cast<std::size_t>(ConditionStep::Kind::both);
    std::vector<std::uint32_t> values;
    const auto pop = [&values] {
      const std::uint32_t top = values.back();
      values.pop_back();
      return top;
    };
    for (const ConditionStep& step : steps) {
      if (step.kind == ConditionStep::Kind::proposition) {
        values.push_back(termOf(step, key, rule));
        continue;
      }
      const Op op = kOps[static_cast<std::size_t>(step.kind) - kFirst];
      const std::uint32_t b = pop(), a = op == Op::both || op == Op::either ? pop() : b;
      values.push_back(any() + 1 + static_cast<std::uint32_t>(parts_.size()));
      parts_.push_back({op, std::max(levelOf(a), levelOf(b)) + 1, a, b});
    }
    rule.condition = values.back();
  }

  std::uint32_t termOf(const ConditionStep& step, const std::string& key, CompiledPolicy::Rule& rule) {
    if (step.term == "any") return any();
    rule.asked |= 1u << static_cast<unsigned>(step.signal);
    const auto found = findTerm(step.signal, step.term);
    if (!found) refuse(key, termsOf(step.signal), std::string(step.term));
    return found ? static_cast<std::uint32_t>(*found) : any();
  }

  /// Puts the parts of all conditions into an order in which few runs do the same.
  void arrangeParts() {
    std::vector<std::uint32_t> order(parts_.size()), place(parts_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {},
                             [this](std::uint32_t i) { return std::pair(parts_[i].level, parts_[i].op); });
    const auto placed = [&](std::uint32_t value) {
      return value <= any() ? value : place[value - any() - 1];
    };
    for (const std::uint32_t i : order) {
      const Part& part = parts_[i];
      if (out_.runs_.empty() || out_.runs_.back().op != part.op) out_.runs_.push_back({part.op, 0});
      ++out_.runs_.back().parts;
      out_.operands_.push_back({placed(part.a), placed(part.b)});
      place[i] = any() + static_cast<std::uint32_t>(out_.operands_.size());
    }
    for (CompiledPolicy::Rule& rule : out_.rules_) rule.condition = placed(rule.condition);
  }

  std::string termsOf(Signal signal) const {
    // Each part of each rule may ask for it.
    constexpr std::size_t kLongest = 400;
    std::string names;
    for (const PolicyTerm& term : policy_.terms) {
      if (term.signal == signal) names += (names.empty() ? ": " : ", ") + term.name;
      if (names.size() > kLongest) return "a term of " + std::string(rowOf(signal).key) + names + " ...";
    }
    return "a term of " + std::string(rowOf(signal).key) + (names.empty() ? ", which has none" : names);
  }

  const Policy& policy_;
  const std::string& where_;
  CompiledPolicy out_;
  std::vector<Part> parts_;
  Findings findings_;
};

Result<CompiledPolicy> compile(const Policy& policy, const std::string& where) {
  return PolicyCompiler(policy, where).run();
}

}  // namespace trimtab
