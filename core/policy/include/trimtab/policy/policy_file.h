#pragma once

#include <string>
#include <string_view>

#include "trimtab/policy/policy.h"

/// Exchanges policies with fuzzylite, in its language (FLL, version 6): each signal that has terms is an
/// input, each lever that a rule sets is an output, a weighted average of constants, which is what
/// CompiledPolicy::decide computes.
namespace trimtab {

/// Returns the text of a file. A negated group is written by De Morgan's laws, as the language negates single
/// terms only; both norms obey them. Switched-off rules and reasons become comments, which readFuzzyLite()
/// reads back. Fails as compile() does. `name`, reduced to letters, digits and _, becomes the engine's.
Result<std::string> toFuzzyLite(const Policy& policy, const std::string& name);

/// Is the inverse, for this program's files and what fuzzylite makes of them. Everything that a policy cannot
/// say is refused with file, line, expected and found, one finding each: unknown signals and levers, other
/// shapes, outputs that are no constants, other norms and defuzzifiers. The policy that it returns compiles.
Result<Policy> readFuzzyLite(std::string_view text, const std::string& where);

}  // namespace trimtab
