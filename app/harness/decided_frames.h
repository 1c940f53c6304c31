#pragma once

#include <vector>

#include "run.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::harness {

/// A sampled row of a flight as one preset and case would have it drawn.
struct DecidedFrame {
  std::size_t row = 0;
  double timeS = 0;
  double decideMs = 0;  ///< median of some
  FrameRequest request;
  /// Of the rows before, oldest first: one, or as many as may leave a trace in a blur.
  std::vector<FrameRequest> before;
};

/// Rows evenly spread over those that lie over the terrain; all of them where there are no more than `count`.
std::vector<std::size_t> sampledRows(const Flight& flight, const terrain::Database& terrain,
                                     std::size_t count);
/// Decides every row of the flight in order and keeps the requests of `rows`, which ascend. Time is the
/// rows', never a clock's.
std::vector<DecidedFrame> decideFrames(const Plan& plan, const Plan::NamedFlight& flight,
                                       const ValidatedParameters& parameters,
                                       const std::vector<std::size_t>& rows);

}  // namespace trimtab::harness
