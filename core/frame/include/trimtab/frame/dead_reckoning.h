#pragma once

#include "trimtab/units/linear.h"

namespace trimtab {

/// How an aircraft moves on until its host sends again, by the host's own promise (IEEE 1278.1, Annex E: the
/// algorithms 1 to 9 of DIS). All zeros mean that it stands still.
struct DeadReckoning {
  bool inBodyAxes =
      false;             ///< velocity and acceleration are forward, right and down, else of the earth (ECEF)
  bool rotates = false;  ///< if false, the attitude stays
  Vec3 velocity, acceleration;  ///< m/s, m/s2
  Vec3 angularVelocity;         ///< about forward, right and down, rad/s

  friend bool operator==(const DeadReckoning&, const DeadReckoning&) = default;
};

}  // namespace trimtab
