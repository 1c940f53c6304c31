#pragma once

#include <random>

#include "trimtab/policy/policy.h"

namespace trimtab::test {

struct PolicySize {
  std::size_t signals = 4, terms = 12, rules = 20, levers = 4;
  bool numeric = false;  ///< only rules that MATLAB's language can say
};

/// A policy with terms of every shape and rules with every connective, hedge and group, all of which compile.
Policy randomPolicy(std::mt19937_64& random, const PolicySize& size);

/// Values of all signals over their usual extent, some of them on the numbers of the policy's terms.
SignalValues randomSignals(std::mt19937_64& random, const Policy& policy);

}  // namespace trimtab::test
