#pragma once

#include <string>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/motion_decision.h"

/// Head motion (document C, section 3): movement of the field of view by Eq. (1), BlurStack and
/// LODRestoreStack, the steps of the LOD scale, and the blur.
///
/// A frame is a state: decisions follow the host's clock, not the pictures. Where states come unevenly, Eq.
/// (1)'s average of frames a second is the step's own: fast means more than the field of view a second. Turns
/// count the short way round, so a sweep of more than 180 degrees between two states looks slower than it is.
namespace trimtab {

/// One state after the other. Pure but for `memory`; no allocation. With MotionControl::off the memory is
/// emptied and the decision is a default one.
MotionDecision decideMotion(const AircraftState& state, const MotionParameters& parameters,
                            MotionMemory& memory);

/// LOD scale so many steps away from full detail; `level` is lowered to the coarsest one there is.
double motionLodScale(const MotionParameters& parameters, std::uint32_t& level);

/// As files and docks spell it; empty past the last one.
std::string_view toText(MotionReason reason);
/// Whether level or blur changed, or what was counted was thrown away.
bool changesState(MotionReason reason);
/// The decision in words and numbers: one line.
std::string explain(const MotionDecision& decision);

}  // namespace trimtab
