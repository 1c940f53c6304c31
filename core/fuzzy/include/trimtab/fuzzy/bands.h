#pragma once

#include <optional>

#include "trimtab/preset/curve.h"

namespace trimtab {

/// Returns the band of a total membership by plain look-up: half-open [low, high), the top one closed; -1 below
/// the first, and for NaN. A total that misses an edge by rounding alone (1e-12) is on the edge and belongs to the
/// band above it.
int bandOf(const BandList& bands, double total);

struct BandChoice {
  int band = -1;
  bool held = false;  ///< the plain look-up says otherwise, by less than the hysteresis
};

/// The band after `previous`: up from an edge + hysteresis on, down below an edge - hysteresis, over several
/// bands at once where the total jumps. The ends of the scale always have their own band: a total of 0 lies
/// below any edge above 0, and kTop in the top band, however large the hysteresis. No previous band, or one
/// that the list no longer has, is a plain look-up.
BandChoice nextBand(const BandList& bands, double hysteresis, double total, std::optional<int> previous);

}  // namespace trimtab
