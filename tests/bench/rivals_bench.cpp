#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "app/harness/answer.h"
#include "app/harness/frame_meter.h"
#include "app/tune/tune.h"
#include "row.h"
#include "sample_world.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/session/session.h"

/// Group `rivals`: what a searched preset is worth beside the default, the best change of one parameter, the
/// best of 200 random presets, and the rules by which two other image generators hold a budget: over the
/// sample's world, a valley of Kansai and Everest.

namespace trimtab::bench {
namespace {

/// A rule that another image generator holds a budget by: it gets the time of each image and sets the
/// parameters of the next.
using Rule = std::function<void(double ms, TuningParameters& next)>;

/// VRSG: "a control loop on an LOD scale", adjusted in each frame upward or downward by the load, which goes
/// back to its default after the load and leaves out no object (metavr.com/products/vrsg/channelsync.html).
/// Its gain is not public: this one moves the scale by the fourth root of what the time is off by.
Rule vrsg(double budgetMs) {
  return [budgetMs](double ms, TuningParameters& next) {
    const double scale = next.lod.scale.value() * std::pow(ms / budgetMs, 0.25);
    next.lod.scale = Ratio{std::clamp(scale, 1.0, 16.0)};
  };
}

/// UNIGINE: one quality goes a step down where the frame time is over the budget by a threshold, and up again
/// (restoring mode) where it is as far below. Steps and threshold are the user's: here eight, from the
/// default to the best change of one parameter that a sweep finds, and a tenth.
Rule unigine(double budgetMs, const ValidatedParameters& best) {
  return [budgetMs, best, step = 0](double ms, TuningParameters& next) mutable {
    constexpr int kSteps = 8;
    constexpr double kThreshold = 0.1;
    if (ms > budgetMs * (1 + kThreshold)) step = std::min(step + 1, kSteps);
    if (ms < budgetMs * (1 - kThreshold)) step = std::max(step - 1, 0);
    const TuningParameters standard;
    for (const ParameterRow& row : parameterRows()) {
      const ParameterValue from = row.get(standard), to = row.get(*best);
      const double *low = std::get_if<double>(&from), *high = std::get_if<double>(&to);
      if (!low || !high || *low == *high) continue;
      const double part = step / double{kSteps};
      const bool ratio = *low > 0 && *high > 0;
      row.set(next, step == kSteps ? *high
                    : ratio        ? *low * std::pow(*high / *low, part)
                                   : std::lerp(*low, *high, part));
    }
  };
}

/// Flies a rule as harness::flyFrames() flies presets: images are drawn for some seconds before each row.
std::vector<harness::FlownFrame> flyRule(experiment::Stage& stage, const tune::Plan& plan,
                                         const Flight& flight, const std::vector<std::size_t>& rows,
                                         const Rule& rule) {
  constexpr std::size_t kBefore = 40;
  TuningParameters parameters;
  Session session{defaultParameters()};
  session.setGround(plan.terrain);
  std::vector<harness::FlownFrame> frames;
  std::vector<FrameRequest> before;
  for (std::size_t row = 0; row < flight.states.size() && frames.size() < rows.size(); ++row) {
    const AircraftState& state = flight.states[row];
    session.fly(state, state.time);
    const std::size_t next = rows[frames.size()];
    if (row + kBefore < next) continue;
    const FrameRequest request = *session.request(state.time, plan.widthPx, plan.heightPx);
    if (row == next) frames.push_back({row, state.time, 0, {{request, before}}});
    rule(stage.fly(request).cost.total, parameters);
    if (const auto valid = validate(parameters)) session.setParameters(*valid);
    before = {request};
  }
  return frames;
}

const tune::Tuned* ofRole(const std::vector<tune::Tuned>& presets, tune::Role role) {
  for (const tune::Tuned& preset : presets)
    if (preset.role == role) return &preset;
  return nullptr;
}

/// Returns the found preset that keeps the budget with the least error where it was searched; the quickest if
/// none keeps it.
const tune::Tuned* bestFound(const std::vector<tune::Tuned>& presets, double budgetMs) {
  const tune::Tuned* best = nullptr;
  const auto worth = [&](const tune::Tuned& t) {
    const double ms = t.measured[0].p95Ms;
    return ms <= budgetMs ? t.measured[0].flip : 1 + ms;
  };
  for (const tune::Tuned& preset : presets)
    if (preset.role == tune::Role::found && (!best || worth(preset) < worth(*best))) best = &preset;
  return best;
}

/// Draws runners in turns over a flight and returns what each is worth.
std::vector<harness::AnswerRow> draw(experiment::Stage& stage, const harness::Plan& plan,
                                     std::vector<harness::Runner>& runners) {
  scene::ErrorMeter meter;
  if (!meter.initialize().usable) return {};
  meter.setTerrain(plan.terrain);
  std::vector<harness::Unit> units(runners.size());
  for (std::size_t f = 0; f < runners[0].frames.size(); ++f) {
    const auto measured = harness::measureFrame(stage, meter, plan, runners, f, [] { return true; });
    for (std::size_t u = 0; u < units.size(); ++u) units[u].frames.push_back((*measured)[u].frames[0]);
  }
  meter.release();
  std::vector<harness::AnswerRow> rows;
  for (const harness::Unit& unit : units) rows.push_back(harness::answerRow(unit, kNan));
  return rows;
}

/// Searches a preset on the first half of a flight for half of the default's p95, and draws it on both halves
/// in turns with the others. `name` is part of the rows' ids.
void rivalRows(Report& report, const std::string& name,
               const std::shared_ptr<const terrain::Database>& terrain, const Flight& flight) {
  const int width = report.quick() ? 640 : 1280, height = width * 9 / 16;
  experiment::Setup setup;
  setup.terrain = terrain;
  setup.widthPx = width;
  setup.heightPx = height;
  const auto half = flight.states.begin() + static_cast<std::ptrdiff_t>(flight.states.size() / 2);
  harness::Plan drawn;
  drawn.terrain = terrain;
  drawn.repeats = report.quick() ? 2 : 5;
  tune::Plan plan;
  plan.terrain = terrain;
  plan.terrainName = name;
  plan.flights = {{"seen", {"seen", {flight.states.begin(), half}}}};
  plan.heldOut = {{"held-out", {"held-out", {half, flight.states.end()}}}};
  plan.free = {"lod.screen_space_error_px",
               "lod.scale",
               "objects.error_px",
               "objects.small_feature_px",
               "objects.far_m",
               "hold.enabled",
               "hold.margin",
               "hold.caution"};
  plan.widthPx = drawn.widthPx = width;
  plan.heightPx = drawn.heightPx = height;
  plan.frames = 20;
  plan.drawnRows = report.quick() ? 8 : 12;
  plan.repeats = report.quick() ? 2 : 3;
  plan.points = report.quick() ? 3 : 4;
  plan.evaluations = report.quick() ? 4000 : 20000;
  const auto fly = [&](experiment::Stage& stage, const Flight& over, const ValidatedParameters& parameters) {
    return *harness::flyFrames(stage, {terrain, width, height, false, 1, {}}, over, parameters,
                               harness::sampledRows(over, *terrain, plan.frames));
  };
  {
    const auto stage = experiment::Stage::open(setup);
    std::vector<harness::Runner> standard{
        {{}, defaultParameters(), fly(**stage, plan.flights[0].flight, defaultParameters())}};
    plan.budgetMs = draw(**stage, drawn, standard)[0].p95Ms / 2;
  }
  const test::ScratchDir folder;
  const auto outcome = tune::run(plan, folder / "run");
  if (!outcome) {
    std::fputs(toString(outcome.findings()).c_str(), stderr);
    return;
  }
  const tune::Tuned* const found = bestFound(outcome->presets, *plan.budgetMs);
  const tune::Tuned* const single = ofRole(outcome->presets, tune::Role::single);
  const tune::Tuned* const random = ofRole(outcome->presets, tune::Role::random);
  if (!found || !single || !random) return;
  // What the search measured itself, in turns, on flights that it saw and did not see.
  for (std::size_t f = 0; f < 2; ++f) {
    const harness::AnswerRow& best = found->measured[f];
    const std::string of = (f == 0 ? "seen" : "held-out"), id = "rivals." + name + '.' + of + '.';
    const auto what = [&](const char* which, const harness::AnswerRow& row) {
      char text[200];
      std::snprintf(text, sizeof text, "mean FLIP over %s of %s, %s; p95 %.1f ms (found %.1f), budget %.1f",
                    of.c_str(), name.c_str(), which, row.p95Ms, best.p95Ms, *plan.budgetMs);
      return std::string(text);
    };
    const auto against = [&](const char* which, double flip, const harness::AnswerRow& row) {
      return Row{.id = id + which,
                 .what = what(which, row),
                 .value = flip,
                 .unit = "FLIP",
                 .peer = which,
                 .peerValue = row.flip,
                 .peerFrom = "run"};
    };
    const bool holds = found->parameters->hold.enabled;
    report.add({.id = id + "found",
                .what = what(holds ? "found, holds the budget" : "found, fixed settings", best),
                .value = best.flip,
                .unit = "FLIP"});
    report.add(valueAtMost(1.1, {.id = id + "budget",
                                 .what = "p95 of the found preset over the budget, " + of + " of " + name,
                                 .value = best.p95Ms / *plan.budgetMs,
                                 .unit = ""}));
    report.add(against("default", best.flip, outcome->presets.front().measured[f]));
    // A goal holds against whoever keeps the budget as well as the found preset is asked to.
    const auto atMost = [&](double goal, Row row, const harness::AnswerRow& other) {
      const bool keeps = other.p95Ms <= 1.1 * *plan.budgetMs;
      if (!keeps) row.what += ": over it by more than a tenth, so no goal";
      report.add(keeps ? ratioAtMost(goal, row) : row);
    };
    atMost(0.7, against("one-parameter", best.flip, single->measured[f]), single->measured[f]);
    atMost(0.8, against("best-of-200-random", best.flip, random->measured[f]), random->measured[f]);
    // The rules of others fly in turns with the found preset.
    const auto stage = experiment::Stage::open(setup);
    const Flight& over = (f == 0 ? plan.flights : plan.heldOut)[0].flight;
    const std::vector<std::size_t> rows = harness::sampledRows(over, *terrain, plan.frames);
    std::vector<harness::Runner> runners{{{}, defaultParameters(), fly(**stage, over, found->parameters)}};
    for (const Rule& rule : {vrsg(*plan.budgetMs), unigine(*plan.budgetMs, single->parameters)})
      runners.push_back({{}, defaultParameters(), flyRule(**stage, plan, over, rows, rule)});
    const std::vector<harness::AnswerRow> worth = draw(**stage, drawn, runners);
    atMost(1, against("vrsg", worth[0].flip, worth[1]), worth[1]);
    atMost(1, against("unigine", worth[0].flip, worth[2]), worth[2]);
  }
}

int run(int argc, char** argv) {
  Report report(argc, argv);
  const auto flight = [](const char* name) {
    return std::move(readFlight(test::sourceDir() / "resources/flights" / name)).value();
  };
  if (report.wants("sample"))
    if (const auto terrain = sampleWorld())
      rivalRows(report, "sample", terrain, flight("yecheon-circuit.csv"));
  for (const auto& [name, folder, flown] : {std::tuple{"kansai", "fg-kansai-e135n35", "kansai-valley.csv"},
                                            std::tuple{"everest", "dem-srtm3-everest", "everest-pass.csv"}}) {
    if (!report.wants(name) || !std::filesystem::exists(test::sharedDir() / "data" / folder)) continue;
    if (const auto terrain = test::bakedOnce(folder)) rivalRows(report, name, *terrain, flight(flown));
  }
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  return trimtab::bench::run(argc, argv);
}
