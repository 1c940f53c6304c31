#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "app/harness/flown_frames.h"
#include "app/tune/flight_model.h"
#include "app/tune/search_space.h"
#include "bench_scene.h"
#include "row.h"
#include "sample_world.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/scene/error_meter.h"

/// Group `tune`: how many presets a second are estimated over a flight, and whether estimates order presets
/// as drawing them does.

namespace trimtab::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr std::size_t kStates = 600;

/// 600 states of the circuit over the sample.
Flight circuit() {
  Flight all = std::move(readFlight(test::sourceDir() / "resources/flights/yecheon-circuit.csv")).value();
  Flight flight;
  flight.name = all.name;
  for (std::size_t i = 0; i < kStates; ++i)
    flight.states.push_back(all.states[i * all.states.size() / kStates]);
  return flight;
}

/// Returns how many estimates a second one core makes of presets around this one.
double perSecond(const tune::FlightModel& model, const TuningParameters& start,
                 const std::vector<std::string>& free, int count) {
  const auto space = tune::SearchSpace::make(start, free);
  if (!space) return 0;
  std::mt19937_64 random(1);
  std::vector<ValidatedParameters> presets;
  const double before = processorMs();
  double sum = 0;
  int made = 0;
  while (made < count) {
    std::vector<double> place(space->size());
    for (double& at : place) at = static_cast<double>(random() >> 11) * 0x1p-53;
    const auto valid = validate(space->at(place));
    if (!valid) continue;
    sum += model.estimate(*valid).error;
    ++made;
  }
  keep(sum);
  return 1e3 * count / (processorMs() - before);
}

/// Returns the rank correlation of two lists (Spearman), without ties to speak of.
double rankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto ranks = [](const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t x, std::size_t y) { return values[x] < values[y]; });
    std::vector<double> rank(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
    return rank;
  };
  const std::vector<double> ra = ranks(a), rb = ranks(b);
  const double mean = (static_cast<double>(a.size()) - 1) / 2;
  double both = 0, ofA = 0, ofB = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += (ra[i] - mean) * (rb[i] - mean);
    ofA += (ra[i] - mean) * (ra[i] - mean);
    ofB += (rb[i] - mean) * (rb[i] - mean);
  }
  return both / std::sqrt(ofA * ofB);
}

/// Presets at random places, every second with the policy that ships for low levels, whose numbers move too.
std::vector<ValidatedParameters> randomPresets(std::size_t count) {
  const std::vector<std::string> free{"lod.screen_space_error_px", "lod.scale=0.5..4", "objects.error_px",
                                      "objects.small_feature_px"};
  std::vector<std::string> withRules = free;
  withRules.insert(withRules.end(), {"policy.terms", "policy.rules"});
  const auto plain = tune::SearchSpace::make({}, free);
  const auto ruled = tune::SearchSpace::make(loadPreset("low-level").value().parameters, withRules);
  std::mt19937_64 random(11);
  std::vector<ValidatedParameters> presets;
  while (presets.size() < count) {
    const tune::SearchSpace& space = presets.size() % 2 == 0 ? *plain : *ruled;
    std::vector<double> place(space.size());
    for (double& at : place) at = static_cast<double>(random() >> 11) * 0x1p-53;
    if (const auto valid = validate(space.at(place))) presets.push_back(*valid);
  }
  return presets;
}

void rankRows(Report& report, experiment::Stage& stage,
              const std::shared_ptr<const terrain::Database>& terrain, const Flight& flight,
              const tune::FlightModel& model) {
  const std::size_t presets = report.quick() ? 16 : 50, rows = report.quick() ? 6 : 16;
  scene::ErrorMeter meter;
  if (!meter.initialize().usable) return;
  meter.setTerrain(terrain);
  const std::vector<ValidatedParameters> all = randomPresets(presets);
  const harness::Flying flying{terrain, kWidth, kHeight, false, 1, {}};
  const std::vector<std::size_t> sampled = harness::sampledRows(flight, *terrain, rows);
  std::vector<std::vector<harness::FlownFrame>> flown;
  for (const ValidatedParameters& preset : all)
    flown.push_back(*harness::flyFrames(stage, flying, flight, preset, sampled));
  std::vector<double> ms(presets), flip(presets), estimatedMs, estimatedFlip;
  for (std::size_t r = 0; r < sampled.size(); ++r)
    for (std::size_t p = 0; p < presets; ++p) {
      const harness::FlownFrame::Image& image = flown[p][r].images[0];
      flip[p] += meter.measure(image.request, image.before, nullptr).flip;
      // The quickest of three, each after the image before it.
      double least = 0;
      for (int turn = 0; turn < 4; ++turn) {
        if (!image.before.empty()) stage.draw(image.before.back());
        const double took = stage.draw(image.request).cost.total;
        if (turn == 1 || (turn > 1 && took < least)) least = took;
      }
      ms[p] += least;
    }
  meter.release();
  for (const ValidatedParameters& preset : all) {
    const tune::Estimate estimate = model.estimate(preset);
    estimatedMs.push_back(estimate.meanMs);
    estimatedFlip.push_back(estimate.error);
  }
  const std::string of = std::to_string(presets) + " presets, half of them policies, " +
                         std::to_string(sampled.size()) + " frames each";
  report.add(valueAtLeast(0.9, {.id = "tune.rank_time",
                                .what = "rank correlation of estimated and drawn mean frame time, " + of,
                                .value = rankCorrelation(estimatedMs, ms),
                                .unit = ""}));
  report.add(valueAtLeast(0.9, {.id = "tune.rank_flip",
                                .what = "rank correlation of estimated and drawn mean FLIP, " + of,
                                .value = rankCorrelation(estimatedFlip, flip),
                                .unit = ""}));
}

int run(int argc, char** argv) {
  Report report(argc, argv);
  const auto terrain = sampleWorld();
  if (!terrain) return 1;
  const Flight flight = circuit();
  const bool wanted = report.wants("build") | report.wants("estimates") | report.wants("rank");
  if (!wanted) return report.finish();
  const double before = processorMs();
  tune::FlightModel model({terrain, kWidth, kHeight}, flight, defaultParameters(), report.quick() ? 6 : 12);
  report.add(
      valueAtMost(3, {.id = "tune.build",
                      .what = "counting a flight of 600 states over the sample's world, processor time",
                      .value = (processorMs() - before) / 1e3,
                      .unit = "s"}));
  experiment::Setup setup;
  setup.terrain = terrain;
  setup.widthPx = kWidth;
  setup.heightPx = kHeight;
  const auto stage = experiment::Stage::open(setup);
  if (!stage) return 1;
  model.learn(
      *tune::drawSamples(**stage, model.toDraw(), tune::ErrorKind::flip, [](double) { return true; }));
  const int count = report.quick() ? 300 : 2000;
  const TuningParameters low = loadPreset("low-level").value().parameters;
  TuningParameters held;
  held.hold.enabled = true;
  const std::vector<std::string> free{"lod.screen_space_error_px", "lod.scale", "objects.error_px"};
  std::vector<std::string> rules = free;
  rules.insert(rules.end(), {"policy.terms", "policy.rules"});
  report.add(valueAtLeast(5000, {.id = "tune.estimates",
                                 .what = "fixed settings estimated over 600 states, a second of one core",
                                 .value = perSecond(model, {}, free, count),
                                 .unit = "/s"}));
  report.add(valueAtLeast(5000, {.id = "tune.estimates_policy",
                                 .what = "policies estimated over 600 states, a second of one core",
                                 .value = perSecond(model, low, rules, count),
                                 .unit = "/s"}));
  report.add(valueAtLeast(400, {.id = "tune.estimates_held",
                                .what = "held budgets estimated over 600 states, a second of one core",
                                .value = perSecond(model, held, free, count / 10),
                                .unit = "/s"}));
  if (report.wants("rank")) rankRows(report, **stage, terrain, flight, model);
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  return trimtab::bench::run(argc, argv);
}
