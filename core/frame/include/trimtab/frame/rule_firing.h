#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "trimtab/preset/rule_list.h"

namespace trimtab {

/// Says how far each rule of the preset's list fires (mu), in the list's order, whatever the combination.
/// Entries beyond `count` are neither set nor copied, because every decision has one of these.
struct RuleFiring {
  std::array<double, RuleList::kCapacity> mu;
  std::size_t count = 0;

  RuleFiring() {}
  RuleFiring(const RuleFiring& other) : count(other.count) { take(other); }
  RuleFiring& operator=(const RuleFiring& other) {
    count = other.count;
    take(other);
    return *this;
  }
  std::span<const double> span() const { return {mu.data(), count}; }
  friend bool operator==(const RuleFiring& a, const RuleFiring& b) {
    return std::equal(a.mu.begin(), a.mu.begin() + static_cast<std::ptrdiff_t>(a.count), b.mu.begin(),
                      b.mu.begin() + static_cast<std::ptrdiff_t>(b.count));
  }

 private:
  void take(const RuleFiring& other) {
    for (std::size_t i = 0; i < count; ++i) mu[i] = other.mu[i];
  }
};

}  // namespace trimtab
