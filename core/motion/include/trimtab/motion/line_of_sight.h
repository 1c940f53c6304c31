#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Returns where the pilot looks, as an attitude in the world; the head's attitude is relative to the
/// aircraft's axes. Without a head, or with one that looks straight ahead, it is exactly the aircraft's.
/// Straight up or down the roll is 0.
Attitude lineOfSight(const Attitude& aircraft, const std::optional<Attitude>& head);

/// Returns the direction in which an attitude looks: a unit vector east, north and up.
Vec3 directionOf(const Attitude& attitude);
/// Returns the angle between two directions, degrees; small angles keep all their digits.
double degreesBetween(Vec3 a, Vec3 b);

}  // namespace trimtab
