#pragma once

#include <span>

#include "trimtab/policy/policy.h"

namespace trimtab {

/// Returns the membership of x, which is no NaN, in a term whose numbers compile() accepts.
double membershipAt(TermShape shape, std::span<const double> numbers, double x);

/// Returns what is wrong with a term's numbers, as "expected" and "found"; nothing if all is well.
struct TermFlaw {
  std::string expected, found;
};
std::optional<TermFlaw> flawOf(const PolicyTerm& term);

}  // namespace trimtab
