#pragma once

#include "trimtab/frame/frame.h"
#include "trimtab/frame/ground_heights.h"

namespace trimtab {

/// Returns the state with a clamped aircraft put on the ground: its height counts from there, and if it
/// conforms to the ground, its pitch and roll count from the slope. Where no ground is known, null included,
/// the sea stands in for it. Any other state is returned unchanged.
AircraftState onGround(AircraftState state, const GroundHeights* ground);

}  // namespace trimtab
