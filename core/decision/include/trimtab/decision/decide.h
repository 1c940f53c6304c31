#pragma once

#include <optional>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/preset/table.h"

namespace trimtab {

/// What one decision remembers for the next: hysteresis, stacks. A default one makes the first decision a
/// plain look-up.
struct DecisionMemory {
  std::optional<int> band;  ///< of the last decision; -1 is *frustum*
  MotionMemory motion{};

  friend bool operator==(const DecisionMemory&, const DecisionMemory&) = default;
};

/// Memberships, scheme, depth-map size and what head motion asks for, for one packet state, with the reason
/// of each. Pure but for `memory`; no allocation. Bit-exact on replay. An altitude or pitch that is not a
/// number gives *frustum*; each part that meets such input leaves its own memory as it was.
FrameDecision decide(const FrameInput& input, const ValidatedParameters& parameters, DecisionMemory& memory);

/// The decision in words and numbers, for the log and the dock: one line.
std::string explain(const FrameDecision& decision, const ValidatedParameters& parameters);

}  // namespace trimtab
