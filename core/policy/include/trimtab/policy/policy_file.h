#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/policy/policy.h"
#include "trimtab/policy/rule_mapping.h"

/// Exchanges policies with fuzzy-logic tools. Each signal that has terms or stands in a rule is an input.
/// Each lever that a rule sets is an output: a weighted average of constants, which CompiledPolicy::decide
/// computes too.
namespace trimtab {

/// Returns the text of a file. Both languages negate single terms only, so a negated group is written by De
/// Morgan's laws: "not (a or b)" becomes "not a and not b". Both values of PolicyNorm obey these laws, so the
/// policy decides the same. Switched-off rules and the reasons of rules become comments, which
/// readPolicyFile() reads back.
///
/// Refuses what compile() and readPolicyFile() refuse. MATLAB's rules are numbers, so for that language it
/// also refuses, with one finding each, rules that mix `and` with `or`, name a signal twice, or give a term
/// hedges other than one of very, somewhat, extremely and seldom, or very twice, each with or without `not`
/// before it.
///
/// `name` stands in the findings. It also becomes the engine's name, with _ for each character that is
/// neither a letter nor a digit of ASCII; an empty one becomes "policy".
Result<std::string> policyFileText(const Policy& policy, const std::string& name, RuleFormat format);

/// Says how a file is read whose variables are no signals and levers, or whose outputs are no constants.
struct RuleFileOptions {
  std::vector<RuleVariable> mapping;
  bool acceptDifference = false;  ///< keeps the file's rules however far the policy is from it
};

/// Reads such a text, also if fuzzylite has read and written it since, and MATLAB's files as people have
/// them. A file that policyFileText() wrote decides as it did, but its terms stand in the order of the
/// signals, and a negated group comes back as negated terms.
///
/// What a policy can only come near to is read with a note that says how near: shapes that become points, and
/// outputs that become constants (see resources/docs/policy.md). Where an output differs by more than 5 % of
/// its range somewhere on a grid, a table of rules replaces the file's rules, with a warning, unless the
/// options accept the difference; the file is refused if no table comes nearer.
///
/// Everything else that a policy cannot say is refused with file, line, expected and found, one finding each:
/// unknown signals and levers, other shapes, outputs that have a default, other norms and defuzzifiers,
/// counts that disagree with the text, a file without rules. `where` is the file's name in the findings. The
/// policy that it returns compiles.
Result<Policy> readPolicyFile(std::string_view text, const std::string& where, RuleFormat format,
                              const RuleFileOptions& options = {});

/// These are the same two functions for one language each.
inline Result<std::string> toFuzzyLite(const Policy& policy, const std::string& name) {
  return policyFileText(policy, name, RuleFormat::fuzzylite);
}
inline Result<Policy> readFuzzyLite(std::string_view text, const std::string& where) {
  return readPolicyFile(text, where, RuleFormat::fuzzylite);
}
inline Result<std::string> toMatlab(const Policy& policy, const std::string& name) {
  return policyFileText(policy, name, RuleFormat::matlab);
}
inline Result<Policy> readMatlab(std::string_view text, const std::string& where,
                                 const RuleFileOptions& options = {}) {
  return readPolicyFile(text, where, RuleFormat::matlab, options);
}

}  // namespace trimtab
