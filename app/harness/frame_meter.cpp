#include "frame_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trimtab/measure/cost_stages.h"
#include "trimtab/policy/signals.h"

namespace trimtab::harness {
namespace {

using experiment::quantileOf;
using experiment::Stage;

/// So many draws wait after each part of a frame. Waiting costs time, so these are not the timed draws.
constexpr std::size_t kPartDraws = 3;

std::vector<double> ofStage(const std::vector<FrameCost>& costs, CostField stage) {
  std::vector<double> values;
  for (const FrameCost& cost : costs)
    if (std::isfinite(cost.*stage)) values.push_back(cost.*stage);
  return values;
}

FrameCost medians(const std::vector<FrameCost>& costs) {
  FrameCost median;
  for (const CostStage& stage : kCostStages) median.*stage.ms = quantileOf(ofStage(costs, stage.ms), 0.5);
  return median;
}

/// Adds what was measured of a frame in one more flight: means, but the largest of what is the largest.
class FrameMean {
 public:
  void add(const MeasuredFrame& frame) {
    for (std::size_t q = 0; q < sums_.size(); ++q) {
      const Quantity& quantity = quantities()[q];
      const double value = quantity.of(frame);
      sums_[q] = !isLargest(quantity) ? sums_[q] + value : flights_ == 0 ? value : std::max(sums_[q], value);
    }
    ++flights_;
  }
  void putInto(MeasuredFrame& frame) const {
    for (std::size_t q = 0; q < sums_.size(); ++q) {
      const Quantity& quantity = quantities()[q];
      if (quantity.kind == Quantity::Kind::cost) continue;
      const double value = isLargest(quantity) ? sums_[q] : sums_[q] / static_cast<double>(flights_);
      quantity.set(frame, quantity.whole ? std::round(value) : value);
    }
  }

 private:
  static bool isLargest(const Quantity& quantity) {
    return quantity.key == "geometric_max_px" || quantity.key == "wrongly_culled_px";
  }
  std::vector<double> sums_ = std::vector<double>(quantities().size());
  std::size_t flights_ = 0;
};

/// Returns the keys of the signals that a decision asked for and nobody knew.
std::vector<std::string> unknownSignals(const FlownFrame& frame) {
  std::vector<std::string> keys;
  for (const SignalRow& row : kSignalRows)
    if (std::all_of(frame.images.begin(), frame.images.end(), [&row](const FlownFrame::Image& image) {
          return (image.request.decision.policy.unknownAsked >> indexOf(row.signal) & 1) != 0;
        }))
      keys.emplace_back(row.key);
  return keys;
}

/// Returns the request without the memory of earlier frames: what is drawn must not depend on what was drawn
/// before, nor on where a run was resumed.
FrameRequest alone(FrameRequest request) {
  request.skips.littleHidden = false;
  return request;
}

/// Measures the errors and counts of a frame: of its one image, or of what each repeat flew to.
void measureImages(experiment::Stage& stage, scene::ErrorMeter& meter, const Plan& plan,
                   const FlownFrame& frame, MeasuredFrame& measured) {
  FrameMean mean;
  std::vector<double> pageMs;
  for (const FlownFrame::Image& image : frame.images) {
    MeasuredFrame one;
    one.error = meter.measure(image.request, image.before, nullptr);
    // The page time is that of the step from the row before, with only that row's pages in memory.
    stage.setTerrain(plan.terrain);
    if (!image.before.empty()) stage.draw(image.before.back());
    const FrameResult first = stage.draw(alone(image.request));
    one.counts = countsOf(first);
    one.levers = image.request.levers.drawn;
    pageMs.push_back(first.cost.page);
    mean.add(one);
  }
  mean.putInto(measured);
  measured.cost.page = quantileOf(pageMs, 0.5);
}

}  // namespace

std::optional<std::vector<Unit>> measureFrame(experiment::Stage& stage, scene::ErrorMeter& meter,
                                              const Plan& plan, const std::vector<Runner>& runners,
                                              std::size_t index, const std::function<bool()>& goOn) {
  std::vector<Unit> units;
  for (const Runner& runner : runners) {
    if (!goOn()) return std::nullopt;
    const FlownFrame& frame = runner.frames[index];
    MeasuredFrame measured;
    measured.row = frame.row;
    measured.timeS = frame.timeS;
    measureImages(stage, meter, plan, frame, measured);
    Unit unit;
    unit.name = runner.name;
    unit.unknownSignals = unknownSignals(frame);
    unit.frames.push_back(std::move(measured));
    units.push_back(std::move(unit));
  }
  const std::size_t n = runners.size();
  std::vector<std::vector<FrameCost>> costs(n), parts(n);
  // A frame that is drawn again finds what was made for the eye's place; after the one before it, it does
  // the work that a flight asks of it.
  const auto inFlight = [&stage](const FlownFrame::Image& image, bool separateStages) {
    if (!image.before.empty()) stage.draw(image.before.back());
    FrameRequest request = image.request;
    request.separateStages = separateStages;
    return stage.draw(request).cost;
  };
  for (const Runner& runner : runners) inFlight(runner.frames[index].ofRepeat(0), false);
  for (std::size_t repeat = 0; repeat < plan.repeats; ++repeat)
    for (std::size_t i = 0; i < n; ++i) {
      // Nobody is always first.
      const std::size_t u = (i + repeat + index) % n;
      costs[u].push_back(inFlight(runners[u].frames[index].ofRepeat(repeat), false));
    }
  for (std::size_t u = 0; u < n; ++u) {
    const FlownFrame& frame = runners[u].frames[index];
    MeasuredFrame& measured = units[u].frames.front();
    const double page = measured.cost.page;
    for (FrameCost& cost : costs[u]) {
      cost.decide = frame.decideMs;
      cost.total += frame.decideMs;
      measured.repeatsMs.push_back(cost.total);
    }
    measured.cost = medians(costs[u]);
    measured.cost.page = page;
    for (std::size_t i = 0; i < std::min(plan.repeats, kPartDraws); ++i)
      parts[u].push_back(inFlight(frame.ofRepeat(i), true));
    const FrameCost ofParts = medians(parts[u]);
    for (const CostStage& part : kCostStages)
      if (part.kind == StageKind::part && std::isnan(measured.cost.*part.ms))
        measured.cost.*part.ms = ofParts.*part.ms;
  }
  return units;
}

}  // namespace trimtab::harness
