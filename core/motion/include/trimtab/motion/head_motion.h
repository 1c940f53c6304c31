#pragma once

#include <string>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/motion_decision.h"

/// Decides head motion (document C, section 3): movement of the field of view by Eq. (1), BlurStack and
/// LODRestoreStack, the steps of the LOD scale, and the blur.
///
/// With MotionFrames::host_states a frame is a state: decisions follow the host's clock, not the images. The
/// average frame rate of Eq. (1) is that of the step between two states, so that fast means more than the
/// field of view per second however unevenly states arrive. With MotionFrames::drawn a frame is an image,
/// whose state the caller passes with the average rate of the images; an image that took long then turns
/// through a larger angle and is fast sooner. Turns count the short way round, so a turn of more than 180
/// degrees between two frames looks slower than it is.
namespace trimtab {

/// Decides one frame after the other. It is pure except for `memory` and allocates nothing. `drawn` matters
/// for MotionFrames::drawn alone: a rate that is unknown or not above 0 is taken from the step between the
/// two frames, and an unknown load counts as one that asks for a coarser level. With MotionControl::off it
/// empties the memory and returns a default decision.
MotionDecision decideMotion(const AircraftState& state, const MotionParameters& parameters,
                            MotionMemory& memory, const DrawnLoad& drawn = {});

/// Returns the LOD scale so many steps from full detail. Lowers `level` to the coarsest level if it is
/// beyond.
double motionLodScale(const MotionParameters& parameters, std::uint32_t& level);

/// Returns the reason as files and docks spell it; empty past the last one.
std::string_view toText(MotionReason reason);
/// Reports if level or blur changed, or both stacks were emptied.
bool changesState(MotionReason reason);
/// Returns the decision in words and numbers, on one line.
std::string explain(const MotionDecision& decision);

}  // namespace trimtab
