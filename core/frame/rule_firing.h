#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "trimtab/preset/rule_list.h"

namespace trimtab {

/// How far each rule of the preset's list fires (mu), in its order; whatever the combination.
struct RuleFiring {
  std::array<double, RuleList::kCapacity> mu{};
  std::size_t count = 0;

  constexpr std::span<const double> span() const { return {mu.data(), count}; }
  friend constexpr bool operator==(const RuleFiring& a, const RuleFiring& b) {
    if (a.count != b.count) return false;
    for (std::size_t i = 0; i < a.count; ++i)
      if (a.mu[i] != b.mu[i]) return false;
    return true;
  }
};

}  // namespace trimtab
