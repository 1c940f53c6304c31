#pragma once

#include <algorithm>

#include "tests/bench/row.h"
#include "trimtab/frame/frame.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// The image of all rows that draw, pixels, and what they draw by.
inline constexpr int kWidth = 1280, kHeight = 720;
inline constexpr double kErrorPx = 2, kMetresAFoot = 0.3048;

/// Whole frames of the culling cases, one after the other on the same view; and the peers that need a
/// terrain.
void frameRows(Report& report);

/// All that the processor does to choose what to draw, beside the frame: over 64 x 64 tiles of the finest
/// level, all of which the cut has.
void stageRows(Report& report);

/// So far above the ground at a place by fractions of the terrain's extent.
GeodeticPosition placeOver(const terrain::Database& database, double east, double north, double aboveM);

}  // namespace trimtab::bench
