#pragma once

#include <string>
#include <string_view>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/policy/policy.h"

/// Exchanges policies with fuzzy-logic tools: each signal that has terms is an input, each lever that a rule
/// sets is an output, a weighted average of constants, which is what CompiledPolicy::decide computes.
namespace trimtab {

/// Returns the text of a file. A negated group is written by De Morgan's laws, as both languages negate
/// single terms only; both norms obey them. Switched-off rules and reasons become comments, which
/// readPolicyFile() reads back. Fails as compile() does, and in MATLAB's language for each rule that its
/// numbers cannot say: `and` mixed with `or`, a signal named twice, hedges other than one after `not`.
/// `name`, reduced to letters, digits and _, becomes the engine's.
Result<std::string> policyFileText(const Policy& policy, const std::string& name, RuleFormat format);

/// Is the inverse, for this program's files and what fuzzylite makes of them. Everything that a policy cannot
/// say is refused with file, line, expected and found, one finding each: unknown signals and levers, other
/// shapes, outputs that are no constants, other norms and defuzzifiers. The policy that it returns compiles.
Result<Policy> readPolicyFile(std::string_view text, const std::string& where, RuleFormat format);

/// The same, in one language.
inline Result<std::string> toFuzzyLite(const Policy& policy, const std::string& name) {
  return policyFileText(policy, name, RuleFormat::fuzzylite);
}
inline Result<Policy> readFuzzyLite(std::string_view text, const std::string& where) {
  return readPolicyFile(text, where, RuleFormat::fuzzylite);
}
inline Result<std::string> toMatlab(const Policy& policy, const std::string& name) {
  return policyFileText(policy, name, RuleFormat::matlab);
}
inline Result<Policy> readMatlab(std::string_view text, const std::string& where) {
  return readPolicyFile(text, where, RuleFormat::matlab);
}

}  // namespace trimtab
