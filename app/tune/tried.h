#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "app/harness/results.h"
#include "flight_model.h"

/// What presets are drawn at in a few rows, beside what they were estimated at. A search finds above all what
/// its estimates flatter, so each preset is corrected by what its own estimate misses.
namespace trimtab::tune {

/// Returns the rows that tell presets apart: in each of `count` equal spans of the rows, the one in which
/// their estimates lie farthest apart in time and error. `estimates` has the same rows for each preset.
std::vector<std::size_t> rowsApart(std::span<const std::vector<RowEstimate>> estimates, std::size_t count);

/// What was drawn over what was estimated, of the rows that were drawn: sums of times, and errors as
/// errorOfImages() has them; 1 where either is 0 or unknown.
struct Missed {
  double time = 1, error = 1;
};
Missed missedBy(ErrorKind kind, std::span<const RowEstimate> estimates,
                std::span<const harness::MeasuredFrame> drawn);

}  // namespace trimtab::tune
