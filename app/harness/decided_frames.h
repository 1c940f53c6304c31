#pragma once

#include <vector>

#include "run.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::harness {

/// A sampled row of a flight, decided for one preset and one case.
struct DecidedFrame {
  std::size_t row = 0;
  double timeS = 0;
  double decideMs = 0;  ///< median of several decisions
  FrameRequest request;
  /// Requests of the rows before, oldest first: one, or as many as can affect a blur.
  std::vector<FrameRequest> before;
};

/// Returns `count` rows spread evenly over those above the terrain, or all of these if there are fewer.
std::vector<std::size_t> sampledRows(const Flight& flight, const terrain::Database& terrain,
                                     std::size_t count);
/// Decides every row of the flight in order and keeps the requests of `rows`, which must ascend. Time
/// comes from the rows, never from a clock.
std::vector<DecidedFrame> decideFrames(const Plan& plan, const Plan::NamedFlight& flight,
                                       const ValidatedParameters& parameters,
                                       const std::vector<std::size_t>& rows);

}  // namespace trimtab::harness
