#pragma once

#include <cstdint>

#include "trimtab/frame/frame.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// What a host says of its height above ground where the terrain contradicts it. Some hosts send the altitude
/// above sea level in its place, others count from where they took off.
struct GroundDoubt {
  /// Two public models of one ground, each with 16 m of error at 90 %, differ by less.
  static constexpr Metres kTooFar{35};
  /// A height that equals the altitude is right over the sea alone, and no sea is this high.
  static constexpr Metres kNoSea{2};

  std::uint64_t states = 0;  ///< that contradict the terrain
  Metres host, terrain;      ///< what both say of the newest of them
  bool isAltitude = false;   ///< the host's equals its altitude
};

/// Returns what to tell: the terrain's height is used, and why the host's is not.
Finding toFinding(const GroundDoubt& doubt);

}  // namespace trimtab
