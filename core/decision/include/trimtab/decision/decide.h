#pragma once

#include <optional>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/frame_levers.h"
#include "trimtab/policy/lever_drive.h"
#include "trimtab/preset/table.h"

namespace trimtab {

/// Holds what one decision remembers for the next: the band, for the hysteresis, the stacks of head motion,
/// and where the levers are. With a default memory the first decision is a plain look-up.
struct DecisionMemory {
  std::optional<int> band;  ///< of the last decision; -1 is the scheme *frustum*
  MotionMemory motion{};
  LeverDrive levers{};

  friend bool operator==(const DecisionMemory&, const DecisionMemory&) = default;
};

/// Decides one state: memberships, scheme and depth map size, head motion and weather, each with its reason.
/// It is pure except for `memory`, allocates nothing, and gives the same bits on replay. An altitude or pitch
/// that is not a number gives *frustum*; a part that gets such input leaves its own memory unchanged.
FrameDecision decide(const FrameInput& input, const ValidatedParameters& parameters, DecisionMemory& memory);
/// Does the same with the weather of decideWeather(), for whoever has decided it already.
FrameDecision decide(const FrameInput& input, const WeatherDecision& weather,
                     const ValidatedParameters& parameters, DecisionMemory& memory);

/// Lets the preset's policy, which it must have, move the levers of a decision, at the time of its state. It
/// is the last step of decide(); the others do not depend on rules. `flight` needs no memberships: the
/// decision has them.
void followPolicy(double timeS, SignalValues flight, const ValidatedParameters& parameters,
                  DecisionMemory& memory, FrameDecision& decision);

/// Returns the chain of the levers up to the policy (frame_levers.h); `drawn` is as the policy leaves them.
LeverChain leversOf(const FrameDecision& decision, const TuningParameters& parameters);
/// Returns the last step of leversOf() alone, for whoever needs no chain and many of them.
FrameLevers askedLevers(const FrameDecision& decision, const TuningParameters& parameters);
/// Returns the chain in another weather, whose far distance no rule changes: for measuring a weather by
/// itself.
LeverChain leversIn(const WeatherDecision& weather, FrameDecision decision,
                    const TuningParameters& parameters);

/// Sets scheme and occlusion resolution to those of a band; -1 is the scheme *frustum*.
void setBand(FrameDecision& decision, const BandList& bands, int band);

/// Returns the decision in words and numbers, on one line, for the log and the dock.
std::string explain(const FrameDecision& decision, const ValidatedParameters& parameters);

}  // namespace trimtab
