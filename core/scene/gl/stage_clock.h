#pragma once

#include <chrono>

#include "gpu_timer.h"
#include "trimtab/measure/cost_stages.h"

namespace trimtab::scene {

/// Divides a frame's time among stages. All time between two calls belongs to one stage, so the stages sum
/// to the total, except for the wait that a measurement asks of a GPU. A stage that no call names was not
/// run and stays NaN. The context must be current for all of its life.
class StageClock {
 public:
  StageClock();

  /// Starts a frame. `software` says that GL runs on this processor, whose work shows in the stage that
  /// waits for it. `separate` waits for it at both ends of each part. With `wait` the total ends with the
  /// GPU's work, and the GPU's figures are of this frame.
  void start(bool software, bool separate, bool wait);
  /// Adds the time since the last call to a stage of the frame.
  void lap(CostField stage);
  /// Adds the time so far to `draw`, and the time until `endPart` to `draw` and to that part of it.
  void beginPart(CostField part);
  void endPart(CostField part);
  /// Ends the frame and returns its cost; the rest of the time belongs to `draw`.
  FrameCost finish();

 private:
  using Clock = std::chrono::steady_clock;
  double lapMs();
  void add(CostField stage, double ms);
  bool gpu() const { return !software_; }

  FrameCost cost_;
  GpuTimer timer_;
  Clock::time_point start_, last_;
  bool software_ = false, separate_ = false, wait_ = false;
};

}  // namespace trimtab::scene
