#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "flown_frames.h"
#include "run.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::harness {

/// One preset in one case, with the frames of the flight in hand.
struct Runner {
  UnitName name;
  ValidatedParameters parameters;
  std::vector<FlownFrame> frames;  ///< empty until they are needed
};

/// Measures the index-th frame of all runners, which have flown: errors, counts and times, the times in
/// turns. Returns a unit with one frame for each runner, in their order; nothing if `goOn`, which is called
/// before each runner, returned false.
std::optional<std::vector<Unit>> measureFrame(experiment::Stage& stage, scene::ErrorMeter& meter,
                                              const Plan& plan, const std::vector<Runner>& runners,
                                              std::size_t index, const std::function<bool()>& goOn);

}  // namespace trimtab::harness
