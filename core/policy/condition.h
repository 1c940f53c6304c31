#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/policy/policy.h"

namespace trimtab {

/// A step of a rule's condition in postfix order: a proposition, or what is done to those before it.
struct ConditionStep {
  enum class Kind : std::uint8_t { proposition, both, either, invert, very, somewhat, extremely, seldom };
  Kind kind = Kind::proposition;
  Signal signal = Signal::altitude;  ///< of a proposition
  std::string_view term;             ///< of a proposition; "any" is none. It points into the condition.
};

/// Reads a condition as PolicyRule says. A finding names `where` and `key`. Whether its terms exist is not
/// looked at.
Result<std::vector<ConditionStep>> readCondition(std::string_view condition, const std::string& where,
                                                 const std::string& key);

/// Returns the same condition with `not` before terms only, by De Morgan's laws.
std::string withSingleTermsNegated(std::span<const ConditionStep> steps);

/// Reports whether a word may name a term: letters, digits and _, and no word of rules.
bool isTermName(std::string_view word);

}  // namespace trimtab
