#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/policy/policy.h"

namespace trimtab {

/// Holds what a policy decides from one set of signals.
struct PolicyDecision {
  LeverValues target;              ///< NaN where no rule fires that sets the lever
  std::uint32_t unknownAsked = 0;  ///< bit s: an enabled rule asks for signal s, which nobody knows
  std::vector<double> membership;  ///< of each term, NaN if its signal is unknown; a 1; then of conditions
  std::vector<double> firing;      ///< of each rule: membership of its condition times its weight, 0..1
};

/// A policy as flat arrays, made once for each edit. A decision looks nothing up by name and, with a
/// PolicyDecision that was used before, allocates nothing.
class CompiledPolicy {
 public:
  CompiledPolicy() = default;

  /// Computes each lever as the weighted mean of the settings of the rules that fire, sum(w u) / sum(w), w
  /// being the rule's firing: Takagi-Sugeno of order zero, Eq. (2) of documents A and B for each lever by
  /// itself. The result is never outside the settings that it is the mean of. A rule that asks for an unknown
  /// signal does not fire, whatever else its condition says.
  void decide(const SignalValues& flight, PolicyDecision& decision) const;

  std::size_t terms() const { return terms_.size(); }
  std::size_t rules() const { return rules_.size(); }
  /// Reports whether a rule that is switched on and has a weight sets the lever; as a bit for each lever.
  bool moves(Lever lever) const { return levers_ >> static_cast<unsigned>(lever) & 1; }
  std::uint32_t levers() const { return levers_; }
  /// Reports whether such a rule asks for the signal.
  bool asks(Signal signal) const { return signals_ >> static_cast<unsigned>(signal) & 1; }

  /// Returns the share of a rule in a lever's value, 0..1; 0 if it has none.
  double share(std::size_t rule, Lever lever, const PolicyDecision& decision) const;

 private:
  friend class PolicyCompiler;

  struct Term {
    TermShape shape;
    std::uint8_t signal;
    std::uint16_t count;  ///< of numbers
    std::uint32_t first;  ///< in numbers_
  };
  /// An operation on one or two values of PolicyDecision::membership.
  enum class Op : std::uint8_t { both, either, invert, very, somewhat, extremely, seldom };
  struct Operands {
    std::uint32_t a, b;  ///< in PolicyDecision::membership; `b` counts only for `both` and `either`
  };
  /// Parts of conditions that the same is done to. Each appends its value, in this order, so that a decision
  /// runs through few loops and never asks what comes next.
  struct Run {
    Op op;
    std::uint32_t parts;
  };
  struct Rule {
    std::uint32_t condition;  ///< in PolicyDecision::membership
    std::uint32_t asked;      ///< bit s: the condition asks for signal s
    double weight;            ///< 0 if the rule is switched off; it has no parts then and asks for nothing
  };

  /// Holds what a rule gives a lever.
  struct Setting {
    std::uint32_t rule;
    double value;
  };

  std::span<const Setting> settingsOf(std::size_t lever) const {
    return std::span(settings_).subspan(firstSetting_[lever],
                                        firstSetting_[lever + 1] - firstSetting_[lever]);
  }
  template <PolicyNorm>
  void computeParts(double* values) const;
  void fireRules(std::uint32_t unknown, PolicyDecision& decision) const;

  PolicyNorm norm_ = PolicyNorm::minimum;
  std::vector<Term> terms_;
  std::vector<double> numbers_;
  std::vector<Run> runs_;
  std::vector<Operands> operands_;  ///< run by run
  std::vector<Rule> rules_;
  std::vector<Setting> settings_;  ///< lever by lever
  std::array<std::uint32_t, kLevers + 1> firstSetting_{};
  std::uint32_t levers_ = 0, signals_ = 0;
};

/// Checks and compiles a policy. Fails with every finding, each at "WHERE: terms.SIGNAL.NAME" or "WHERE:
/// rules.N" (from 1): shapes with a wrong count of numbers, falling or no width, not-a-number; terms that
/// stand twice; conditions with unknown words; settings outside a lever's hard range, none, or two of one
/// lever; weights outside 0..1; more than the limits of policy.h.
Result<CompiledPolicy> compile(const Policy& policy, const std::string& where);

}  // namespace trimtab
