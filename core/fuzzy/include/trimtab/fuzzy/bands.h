#pragma once

#include <optional>

#include "trimtab/preset/curve.h"

namespace trimtab {

/// Returns the band of a total membership by plain look-up: half-open [low, high), the top one closed; -1
/// below the first, and for NaN. A total that misses an edge by rounding alone (1e-12) is on the edge and
/// belongs to the band above it.
int bandOf(const BandList& bands, double total);

struct BandChoice {
  int band = -1;
  bool held = false;  ///< whether the hysteresis keeps it from the band of the plain look-up
};

/// Returns the band that follows `previous`. The band rises when the total reaches an edge + hysteresis, and
/// falls when it is below an edge - hysteresis, over several bands at once if the total jumps. The ends of
/// the scale always have their own band, however large the hysteresis: 0 lies below any edge above 0, and
/// kTop in the top band. Without a previous band, or with one that the list no longer has, it is a plain
/// look-up.
BandChoice nextBand(const BandList& bands, double hysteresis, double total, std::optional<int> previous);

}  // namespace trimtab
