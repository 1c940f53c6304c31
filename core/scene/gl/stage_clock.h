#pragma once

#include <chrono>

#include "gpu_timer.h"
#include "trimtab/measure/cost_stages.h"

namespace trimtab::scene {

/// Where a frame's time goes. Whatever passes between two calls belongs to one stage, so that the stages sum
/// to the total (but for the wait that a measurement asks of a GPU); a stage that no call names was not run
/// and stays NaN. The context is current for all of its life.
class StageClock {
 public:
  StageClock();

  /// `software`: the GPU is this processor, whose work shows up in the stage that waits for it.
  /// `separate`: it is waited for at both ends of each part.
  /// `wait`: the total ends with the GPU's work, and the GPU's figures are this frame's.
  void start(bool software, bool separate, bool wait);
  /// What passed since the last call belongs to `stage`, of the frame.
  void lap(CostField stage);
  /// What passed so far belongs to `draw`; what passes up to `endPart` to `draw` and to that part of it.
  void beginPart(CostField part);
  void endPart(CostField part);
  /// The picture is finished, or as far as a GPU lets the processor know. Rests are `draw`'s.
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
