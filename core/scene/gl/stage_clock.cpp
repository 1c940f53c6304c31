#include "stage_clock.h"

#include <cmath>

#include "gl_api.h"

namespace trimtab::scene {
namespace {

constexpr std::size_t kWholeFrame = kCostStages.size();

/// Spans of the GPU's timer are numbered as the stages are; the whole frame comes after them.
std::size_t spanOf(CostField stage) {
  std::size_t i = 0;
  while (kCostStages[i].ms != stage) ++i;
  return i;
}

}  // namespace

StageClock::StageClock() : timer_(kCostStages.size() + 1) {}

void StageClock::start(bool software, bool separate, bool wait) {
  software_ = software;
  separate_ = software && separate;
  wait_ = wait;
  for (const CostStage& stage : kCostStages) cost_.*stage.ms = FrameCost::kNotMeasured;
  start_ = last_ = Clock::now();
  if (!gpu()) return;
  timer_.beginFrame();
  timer_.begin(kWholeFrame);
}

double StageClock::lapMs() {
  const auto now = Clock::now();
  const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
  last_ = now;
  return ms;
}

void StageClock::add(CostField stage, double ms) {
  double& sum = cost_.*stage;
  sum = std::isnan(sum) ? ms : sum + ms;
}

void StageClock::lap(CostField stage) {
  add(stage, lapMs());
}

void StageClock::beginPart(CostField part) {
  if (gpu()) timer_.begin(spanOf(part));
  if (separate_) glFinish();
  lap(&FrameCost::draw);
}

void StageClock::endPart(CostField part) {
  if (gpu()) timer_.end(spanOf(part));
  if (separate_) glFinish();
  const double ms = lapMs();
  add(&FrameCost::draw, ms);
  if (separate_) add(part, ms);
}

FrameCost StageClock::finish() {
  if (gpu()) {
    timer_.end(kWholeFrame);
    timer_.endFrame();
    lap(&FrameCost::draw);
    if (wait_) {
      glFinish();
      timer_.collect();
      last_ = Clock::now();
    }
    cost_.gpu = timer_.milliseconds(kWholeFrame);
    for (const CostStage& stage : kCostStages)
      if (stage.kind == StageKind::part) cost_.*stage.ms = timer_.milliseconds(spanOf(stage.ms));
  } else {
    // A software rasteriser works on after the calls return; without waiting its cost would show up anywhere.
    // It has no `gpu`: that time is in `draw` already, and would count twice.
    glFinish();
    lap(&FrameCost::draw);
  }
  cost_.total = std::chrono::duration<double, std::milli>(last_ - start_).count();
  return cost_;
}

}  // namespace trimtab::scene
