#pragma once

#include <array>
#include <cstdint>

#include "trimtab/policy/levers.h"

namespace trimtab {

/// Holds what the policy of a preset sets in a frame; a default one sets nothing.
struct PolicyOutcome {
  std::array<double, kLevers> value{};  ///< after rates and dead bands; only those in `moved` count
  std::uint32_t moved = 0;              ///< bit l: some rule may set lever l
  std::uint32_t unknownAsked = 0;       ///< bit s: a rule needs signal s, which is unknown

  bool moves(Lever lever) const { return moved >> static_cast<unsigned>(lever) & 1; }
  double operator[](Lever lever) const { return value[static_cast<std::size_t>(lever)]; }
  friend bool operator==(const PolicyOutcome&, const PolicyOutcome&) = default;
};

}  // namespace trimtab
