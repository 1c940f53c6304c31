#pragma once

#include "trimtab/policy/policy.h"
#include "trimtab/preset/parameters.h"

/// A policy as the lines of text that presets hold.
namespace trimtab {

/// Returns the policy that the lines say. A term is "SIGNAL NAME = SHAPE NUMBERS"; a rule is what
/// readPolicyRule() reads, with "off " before it if it is switched off and " # REASON" after it if it has
/// one. Findings have the key policy.terms or policy.rules and name the line. compile() checks the rest.
Result<Policy> policyOf(const PolicyParameters& parameters);

/// Returns the lines of a policy; policyOf() of them is the same policy. `enabled` stays as it is in `onto`.
PolicyParameters policyLines(const Policy& policy, PolicyParameters onto = {});

}  // namespace trimtab
