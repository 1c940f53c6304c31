#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/core/culling/random_index.h"
#include "trimtab/hold/frame_hold.h"
#include "trimtab/units/not_finite.h"

/// A simulated machine with two clocks, and a flight on it with and without the budget held. Nothing depends
/// on a real clock, so a run gives the same bits everywhere.
namespace trimtab::test {

/// What one image costs, milliseconds.
struct TwoClockMachine {
  double processor = 3, processorPerTriangle = 1e-5;
  double gpu = 1, gpuPerTriangle = 5e-5, gpuPerMpx = 9;
  double slowness = 1;  ///< of the GPU's clock

  double processorMs(double triangles) const { return processor + processorPerTriangle * triangles; }
  double gpuMs(double triangles, double sceneMpx) const {
    return slowness * (gpu + gpuPerTriangle * triangles + gpuPerMpx * sceneMpx);
  }
};

/// A machine that changes over a flight.
struct TwoClockCase {
  std::string id, name;
  TwoClockMachine (*at)(int image);
  int every;     ///< images between two changes
  int late = 1;  ///< images by which the GPU's times are late
  double budgetMs = 9;
};

inline std::vector<TwoClockCase> twoClockCases() {
  return {
      {"processor", "bound by the processor", [](int) { return TwoClockMachine{.processor = 20}; }, 2000},
      {"gpu", "bound by the GPU", [](int) { return TwoClockMachine{}; }, 2000},
      {"gpu_late", "bound by a GPU whose times come three images late", [](int) { return TwoClockMachine{}; },
       2000, 3},
      {"either", "bound now by the processor and now by the GPU",
       [](int i) { return TwoClockMachine{.processor = i / 150 % 2 == 1 ? 20.0 : 3.0}; }, 150},
      {"gpu_clock", "bound by a GPU whose clock halves and doubles",
       [](int i) { return TwoClockMachine{.slowness = i / 200 % 2 == 1 ? 2.0 : 1.0}; }, 200, 2},
      {"unexplained", "with a processor whose times nothing explains",
       [](int i) { return TwoClockMachine{.processor = i / 12 % 2 == 1 ? 24.0 : 3.0}; }, 2000},
  };
}

/// What came of a flight. Images are split by whether any setting within the limits fits the budget. The
/// first images, and those after a change of the machine, do not count: the model learns.
struct TwoClockRun {
  std::vector<double> reachable, unreachable;  ///< work of each image, milliseconds
  int images = 0, lowered = 0, notTrusted = 0;
};

inline double p99Of(std::vector<double> ms) {
  if (ms.empty()) return kNan;
  std::sort(ms.begin(), ms.end());
  return ms[(ms.size() - 1) * 99 / 100];
}

class TwoClockFlight {
 public:
  TwoClockFlight() {
    auto index = std::make_shared<LoadIndex>();
    index->tiles = std::make_shared<const TerrainIndex>(randomIndex(32, 4));
    index->frame = LocalFrame(GeodeticPosition{});
    index_ = index;
  }

  TwoClockRun fly(const TwoClockCase& c, bool holds) {
    constexpr int kImages = 1200, kLearns = 60;
    FrameHold hold;
    hold.setIndex(index_);
    HoldParameters p;
    p.enabled = holds;
    TwoClockRun run;
    std::deque<double> gpu;
    std::mt19937 random(29);
    for (int i = 0; i < kImages; ++i) {
      const TwoClockMachine machine = c.at(i);
      FrameRequest request = requestAt(i);
      const double leastMs = std::max(machine.processorMs(trianglesOf(request, p.errorMaximum.value())),
                                      machine.gpuMs(trianglesOf(request, p.errorMaximum.value()),
                                                    mpxOf(request, p.renderScaleMinimum.value())));
      HoldDecision d;
      if (holds) {
        std::vector<ComingEye> coming;
        for (int k = 1; k <= 5; ++k) coming.push_back({requestAt(i + k).eye, requestAt(i + k).attitude});
        d = hold.decide(hold.look(request, coming, c.budgetMs), p, request);
      }
      const double noise = std::normal_distribution<double>(1, 0.03)(random);
      const double triangles = trianglesOf(request, request.levers.drawn.errorPx);
      gpu.push_back(noise * machine.gpuMs(triangles, mpxOf(request, request.levers.drawn.renderScale)));
      FrameResult result;
      result.visible.triangles = static_cast<std::uint64_t>(triangles);
      result.cost.total = noise * machine.processorMs(triangles);
      const double work = std::max(gpu.back(), result.cost.total);
      result.cost.gpu = kNan;
      if (gpu.size() > static_cast<std::size_t>(c.late)) {
        result.cost.gpu = gpu.front();
        gpu.pop_front();
      }
      hold.finished(result, result.cost);
      if (i % c.every < kLearns) continue;
      (leastMs <= 0.85 * c.budgetMs ? run.reachable : run.unreachable).push_back(work);
      ++run.images;
      run.lowered += d.held != d.asked;
      run.notTrusted += d.reason == HoldReason::not_trusted;
    }
    return run;
  }

 private:
  /// An eye that flies on, with a head that looks around.
  static FrameRequest requestAt(int image) {
    FrameRequest request;
    request.time = image / 60.0;
    request.eye = {Degrees{0.1 + image * 2e-6}, Degrees{0.1}, Metres{2500}};
    request.attitude = {Degrees{45 + 40 * std::sin(image / 60.0)}, Degrees{-10}, {}};
    return request;
  }
  double trianglesOf(FrameRequest request, double errorPx) {
    request.levers.drawn = withBudget(request.levers.policy, {errorPx, 1, 1, 1});
    const EyePose eye{index_->frame.fromGeodetic(request.eye),
                      eyeAxes(index_->frame, request.eye, request.attitude)};
    const CutRule rule = cutKeyOf(request, eye.position, 1).rule;
    return countTriangles(*index_->tiles, {eye, request.view}, rule, errorPx, stack_).front();
  }
  static double mpxOf(const FrameRequest& request, double scale) {
    return 1e-6 * request.view.widthPx * request.view.heightPx * scale * scale;
  }

  std::shared_ptr<const LoadIndex> index_;
  std::vector<std::uint64_t> stack_;
};

}  // namespace trimtab::test
