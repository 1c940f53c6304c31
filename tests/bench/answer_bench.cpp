#include <algorithm>
#include <cmath>
#include <string>

#include "app/harness/answer.h"
#include "app/harness/run.h"
#include "bench_scene.h"
#include "tests/support.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/scene/data_extent.h"

/// Group `answer`: how often noise alone tells a preset apart from itself, on this machine as it is.
namespace trimtab::bench {
namespace {

/// Across the terrain from corner to corner, some 500 m above it.
Flight across(const terrain::Database& terrain) {
  constexpr int kStates = 120;
  Flight flight;
  flight.name = "across";
  for (int i = 0; i < kStates; ++i) {
    const double part = 0.1 + 0.8 * i / kStates;
    AircraftState state;
    state.time = i * 0.5;
    state.packet = static_cast<std::uint64_t>(i);
    state.position = scene::placeIn(terrain.info(), part, part);
    const auto ground =
        terrain.highestWithin(state.position.latitude, state.position.longitude, Metres{2000});
    state.position.height = ground.value_or(Metres{0}) + Metres{500};
    state.attitude.heading = Degrees{45};
    flight.states.push_back(state);
  }
  return flight;
}

void selfRows(Report& report) {
  harness::Plan plan;
  plan.terrain = sampleTerrain(10);
  if (!plan.terrain) return;
  plan.terrainName = "sample";
  plan.flights = {{"across", across(*plan.terrain)}};
  plan.presets = {{"one", defaultParameters()}, {"the same", defaultParameters()}};
  plan.cases = {CullingCase::proposed};
  plan.widthPx = 320;
  plan.heightPx = 180;
  plan.frames = 20;
  plan.repeats = 3;
  plan.worst = 0;
  plan.skips = false;
  const int repeats = report.quick() ? 20 : 100;
  double apart = 0, unequal = 0, busy = 0;
  for (int i = 0; i < repeats; ++i) {
    const test::ScratchDir dir;
    const Result<harness::Results> results = harness::run(plan, dir.path());
    if (!results) {
      std::cerr << toString(results.findings());
      return;
    }
    // A budget among the frames' times, where what fits is closest to noise.
    const double budgetMs = harness::answerRow(results->units.front(), 0).p95Ms;
    const harness::Answer answer = harness::answerOf(*results, "across", budgetMs);
    apart += answer.isBest(0) != answer.isBest(1);
    const MeasuredDifference time = differenceOf(results->comparisons.front().frameTime);
    unequal += time == MeasuredDifference::less || time == MeasuredDifference::more;
    busy += isBusy(results->othersShare);
  }
  const std::string of = " of " + std::to_string(repeats) + " runs of one preset under two names";
  const std::string machine =
      busy > 0 ? " (the machine was busy in " + std::to_string(std::lround(busy)) + " of them)" : "";
  report.add(valueAtMost(10, {.id = "answer.self",
                              .what = "Share" + of + " in which the verdict tells them apart" + machine,
                              .value = 100 * apart / repeats,
                              .unit = "%"}));
  report.add(
      valueAtMost(10, {.id = "answer.self_time",
                       .what = "Share" + of + " in which the 95 % interval of their frame times does " +
                               "not hold equality" + machine,
                       .value = 100 * unequal / repeats,
                       .unit = "%"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  if (report.wants("self")) trimtab::bench::selfRows(report);
  return report.finish();
}
