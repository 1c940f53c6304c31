#pragma once

#include <optional>

#include "trimtab/preset/curve.h"

namespace trimtab {

/// Returns the index of the band that holds a total membership, without hysteresis. A band begins at its
/// `low` and ends below the next one's; the top band has no end. The result is -1 below the first band, for
/// NaN and for an empty list. A total above 0 that is below an edge by rounding alone counts as on it,
/// because sums of memberships miss their exact values by some ulps.
int bandOf(const BandList& bands, double total);

struct BandChoice {
  int band = -1;      ///< its index, or -1 below the first
  bool held = false;  ///< whether the hysteresis keeps it from the band that bandOf() returns
};

/// Returns the band that follows `previous`, which may be -1. The band rises when the total reaches an edge +
/// hysteresis, and falls when it is below an edge - hysteresis, over several bands at once if the total
/// jumps. At the ends of the scale, 0 and BandList::kTop, and beyond them the hysteresis does not count,
/// because a large one would lock out the band there for good. It does not count either without a previous
/// band, or if the list no longer has it. NaN gives -1.
BandChoice nextBand(const BandList& bands, double hysteresis, double total, std::optional<int> previous);

}  // namespace trimtab
