#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Where the pilot looks, in the world: the head's attitude is relative to the aircraft's axes. Exactly the
/// aircraft's without a head, or with one that looks straight ahead. Straight up or down, roll is taken as 0.
Attitude lineOfSight(const Attitude& aircraft, const std::optional<Attitude>& head);

}  // namespace trimtab
