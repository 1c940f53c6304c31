#pragma once

#include "trimtab/policy/policy.h"

/// Looks for what is allowed in a policy and is probably not meant.
namespace trimtab {

/// Returns what somebody who reads the policy with care would ask about. `key` says what each finding is
/// about, so that an editor can lead there:
///
/// - "terms.SIGNAL.NAME": a term that no rule which is switched on asks for (warning);
/// - "rules.N", from 1: a rule that fires at most 0.01 anywhere in its signals' ranges (warning), or that
///   fights with the rule that `found` names: both fire by 0.6 or more at the place that it gives and set a
///   lever at least half of its usual range apart (warning);
/// - "rules": a region of the flight in which no rule fires, so that every lever rests (note), as the ranges
///   of the signals that bound it;
/// - "levers": the levers that no rule sets (note).
///
/// A policy that compile() refuses gives its findings instead, and an empty one none. The search samples the
/// signals between the numbers of their terms with a fixed sequence, so that the same policy has the same
/// findings: what is reported was seen, but a small region may be missed. The number of samples falls with
/// the size of the policy; 40 rules over 8 signals take some milliseconds.
Findings reviewPolicy(const Policy& policy);

}  // namespace trimtab
