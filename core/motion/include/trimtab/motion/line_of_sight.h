#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Returns where the pilot looks, as an attitude in the world; the head's attitude is relative to the
/// aircraft's axes. Without a head, or with one that looks straight ahead, it is exactly the aircraft's.
/// Straight up or down the roll is 0.
Attitude lineOfSight(const Attitude& aircraft, const std::optional<Attitude>& head);

}  // namespace trimtab
