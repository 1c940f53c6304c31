#pragma once

#include <array>
#include <cstdint>

#include "trimtab/policy/levers.h"

namespace trimtab {

/// What the policy of a preset sets in a frame; a default one sets nothing.
struct PolicyOutcome {
  std::array<double, kLevers> value{};  ///< of the levers in `moved`, after their rates and dead bands
  std::uint32_t moved = 0;              ///< bit l: rules of the preset set lever l
  std::uint32_t unknownAsked = 0;       ///< bit s: a rule asks for signal s, which nobody knows

  bool moves(Lever lever) const { return moved >> static_cast<unsigned>(lever) & 1; }
  double operator[](Lever lever) const { return value[static_cast<std::size_t>(lever)]; }
  friend bool operator==(const PolicyOutcome&, const PolicyOutcome&) = default;
};

}  // namespace trimtab
