#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "app/experiment/experiment.h"
#include "bench_scene.h"
#include "row.h"
#include "trimtab/decision/decide.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

/// Group `motion`: document C's controllers, what they win over its sweep, and what blur and symbols cost.

namespace trimtab::bench {
namespace {

ValidatedParameters withControl(MotionControl control) {
  TuningParameters p = *defaultParameters();
  p.motion.control = control;
  return *validate(p);
}

/// A head that rests, sweeps and trembles, at 60 Hz.
std::vector<FrameInput> headTurning(std::size_t states) {
  std::mt19937 random(3);
  std::normal_distribution<double> tremble(0, 0.2);
  std::vector<FrameInput> inputs(states);
  double heading = 0;
  for (std::size_t i = 0; i < states; ++i) {
    if (i / 90 % 2 == 1) heading += 2.5;
    AircraftState& s = inputs[i].state;
    s.time = static_cast<double>(i) / 60;
    s.packet = i;
    s.position.height = Feet{2000 + 500 * std::sin(s.time)}.as<Metres>();
    s.head = Attitude{Degrees{std::remainder(heading + tremble(random), 360)}, Degrees{tremble(random)}, {}};
  }
  return inputs;
}

void decisions(Report& report) {
  const auto inputs = headTurning(report.quick() ? 20'000 : 200'000);
  std::size_t lowered = 0;
  const auto seconds = [&](MotionControl control) {
    const ValidatedParameters parameters = withControl(control);
    return leastSeconds(report.quick() ? 5 : 15, [&] {
      DecisionMemory memory;
      std::size_t coarse = 0;
      for (const FrameInput& input : inputs) coarse += decide(input, parameters, memory).motion.lodScale > 1;
      keep(coarse);
      lowered = coarse;
    });
  };
  const double without = seconds(MotionControl::off), with = seconds(MotionControl::with_restoration);
  const auto count = static_cast<double>(inputs.size());
  Row row{"motion.per_second",
          "decide() a second with head motion, of a head that rests, sweeps and trembles (" +
              std::to_string(100 * lowered / inputs.size()) + " % of the frames at a coarser level)",
          count / with,
          "1/s",
          "the same decisions without head motion",
          count / without,
          "run"};
  if (lowered == 0) row.value = NAN;  // nothing of it was run
  report.add(valueAtLeast(1e6, row));
}

void sweep(Report& report, const std::shared_ptr<const terrain::Database>& terrain) {
  experiment::Setup setup;
  setup.terrain = terrain;
  setup.parameters = *defaultParameters();
  setup.repeats = report.quick() ? 1 : 5;
  if (report.quick()) setup.widthPx = 640, setup.heightPx = 360;
  const auto measured = experiment::runHeadMotion(setup);
  if (!measured) {
    std::cerr << toString(measured.findings());
    return;
  }
  const experiment::Table& table = measured->measured;
  const auto cell = [&](std::string_view quantity, std::string_view column) {
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      if (table.text(row, "quantity") == quantity) return table.number(row, column);
    return static_cast<double>(NAN);
  };
  // Document C publishes rates of the first alone: 100 a second before, 170 with it.
  for (const auto& [mode, goal] : {std::pair{"lod_scale_and_blur", 100.0 / 170}, {"with_restoration", 1.0}})
    report.add(ratioAtMost(goal, {.id = std::string("motion.slowest_") + mode,
                                  .what = std::string("slowest frame of document C's sweep, ") + mode,
                                  .value = 1000 / cell("fps_min", mode),
                                  .unit = "ms",
                                  .peer = "the same sweep without the mechanism",
                                  .peerValue = 1000 / cell("fps_min", "before"),
                                  .peerFrom = "run"}));
  report.add(
      ratioAtMost(31.0 / 44, {.id = "motion.vertices",
                              .what = "vertices in view, mean to the end of the rest (published: 44,000 "
                                      "to 31,000)",
                              .value = cell("vertices_in_view", "lod_scale_and_blur"),
                              .unit = "vertices",
                              .peer = "the same sweep without the mechanism",
                              .peerValue = cell("vertices_in_view", "before"),
                              .peerFrom = "run"}));
}

FrameRequest withSymbols(FrameRequest r, double speedKt) {
  TuningParameters p = *defaultParameters();
  p.symbology.enabled = true;
  r.symbology =
      SymbologyRequest{{r.attitude, r.attitude, Metres{1234}, Knots{speedKt}, true, {}}, symbologySetup(p)};
  return r;
}

void passes(Report& report, BenchScene& bench) {
  const int frames = report.quick() ? 15 : 60;
  auto r = bench.request();
  r.levers.drawn.blurStrength = 0.8;
  r.separateStages = true;
  // A head that turns: the blurred frame as it is, and blur's part in it.
  std::vector<double> blur, frame, symbols, standing;
  for (int i = 0; i < frames + 5; ++i) {
    r.time += 1.0 / 60;
    r.attitude.heading = r.attitude.heading + Degrees{1};
    const FrameCost cost = bench.draw(r).cost;
    if (i < 5) continue;
    blur.push_back(cost.blur);
    frame.push_back(cost.total);
  }
  report.add(ratioAtMost(0.1, {.id = "motion.blur",
                               .what = "blur pass of a turning head's frame, 1280 x 720",
                               .value = experiment::quantileOf(blur, 0.5),
                               .unit = "ms",
                               .peer = "the whole frame",
                               .peerValue = experiment::quantileOf(frame, 0.5),
                               .peerFrom = "run"}));

  r = bench.request();
  r.separateStages = true;
  std::uint64_t first = 0, redraws = 0, draws = 0;
  for (int i = 0; i < frames + 5; ++i) {
    r.time += 1.0 / 60;
    const FrameResult result = bench.draw(withSymbols(r, 240));
    if (i == 0) first = result.counters.symbologyRedraws, draws = result.counters.symbologyDraws;
    redraws = result.counters.symbologyRedraws - first;
    if (i >= 5) standing.push_back(result.cost.symbology);
    if (i + 1 == frames + 5) draws = result.counters.symbologyDraws - draws;
  }
  report.add(valueAtMost(
      0, {.id = "motion.symbols_at_rest",
          .what = "times the symbols were made again in " + std::to_string(draws) + " frames at rest",
          .value = static_cast<double>(redraws),
          .unit = "redraws"}));
  frame.clear();
  for (int i = 0; i < frames; ++i) {
    r.time += 1.0 / 60;
    const FrameCost cost = bench.draw(withSymbols(r, 240 + i)).cost;
    symbols.push_back(cost.symbology);
    frame.push_back(cost.total);
  }
  const double whole = experiment::quantileOf(frame, 0.5);
  report.add(ratioAtMost(0.05, {.id = "motion.symbols_still",
                                .what = "all symbols over a frame in which none changes",
                                .value = experiment::quantileOf(standing, 0.5),
                                .unit = "ms",
                                .peer = "the whole frame",
                                .peerValue = whole,
                                .peerFrom = "run"}));
  report.add(ratioAtMost(0.05, {.id = "motion.symbols",
                                .what = "all symbols over a frame in which they change",
                                .value = experiment::quantileOf(symbols, 0.5),
                                .unit = "ms",
                                .peer = "the whole frame",
                                .peerValue = whole,
                                .peerFrom = "run"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  if (report.wants("decisions")) bench::decisions(report);
  const auto terrain = bench::sampleTerrain(40);
  if (!terrain) return 1;
  if (report.wants("sweep")) bench::sweep(report, terrain);
  bench::BenchScene scene(terrain);
  if (report.wants("passes") && scene.ready()) bench::passes(report, scene);
  return report.finish();
}
