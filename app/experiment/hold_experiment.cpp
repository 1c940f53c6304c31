#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <utility>

#include "hold_run.h"
#include "trimtab/host/head_log.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::experiment {
namespace {

constexpr std::size_t kMeasured = 8;
constexpr std::array kFixedErrorsPx{16.0, 8.0, 5.7, 4.0, 2.0, 1.0};  ///< coarsest first
constexpr std::array kFixedScales{1.0, 0.7, 0.5};
/// A setting whose median and 99th percentile are so many times those of mode *hold* is too slow, whatever
/// the noise.
constexpr double kFarTooSlow = 1.3;
constexpr const char* kBuiltInHead = "sweep:120/0.7/1";

using Runs = std::array<HoldRun, kHoldModes.size()>;
using Stages = std::array<std::unique_ptr<Stage>, kHoldModes.size()>;

std::vector<double> ofStrain(const std::vector<double>& values, const Strain& strain) {
  return {values.begin() + std::ptrdiff_t(strain.from), values.begin() + std::ptrdiff_t(strain.to)};
}

/// Returns the images of the strain, and after it, that differ from the image before.
std::vector<std::size_t> changes(const std::vector<double>& values, const Strain& strain) {
  std::vector<std::size_t> images;
  for (std::size_t i = std::max<std::size_t>(strain.from, 1); i < values.size(); ++i)
    if (std::abs(values[i] / values[i - 1] - 1) > 0.01) images.push_back(i);
  return images;
}

/// Returns the most changes within any second, which is as long as a glance lasts.
std::size_t mostInASecond(const std::vector<std::size_t>& images, const Strain& strain) {
  std::size_t most = 0;
  for (std::size_t first = 0, i = 0; i < images.size(); ++i) {
    while (strain.states[images[i]].time - strain.states[images[first]].time > 1) ++first;
    most = std::max(most, i + 1 - first);
  }
  return most;
}

/// Says how the levers settled after the strain.
struct Settling {
  double ms;                 ///< from the end of the strain until they stay; NaN without images after it
  double slowestOverMedian;  ///< of the images until then, over the median of those that follow
};
Settling settlingOf(const HoldRun& run, const Strain& strain) {
  const std::size_t end = run.ms.size();
  if (strain.to >= end) return {kNan, kNan};
  const auto isFinal = [&](std::size_t i) {
    return std::abs(run.errorPx[i] / run.errorPx.back() - 1) < 0.01 &&
           std::abs(run.renderScale[i] - run.renderScale.back()) < 0.01 &&
           std::abs(run.particles[i] - run.particles.back()) < 0.01;
  };
  std::size_t settled = end;
  while (settled > strain.to && isFinal(settled - 1)) --settled;
  const auto at = [&](std::size_t i) { return run.ms.begin() + std::ptrdiff_t(i); };
  const double seconds = strain.states[settled].time - strain.states[strain.to].time;
  return {1e3 * seconds, *std::max_element(at(strain.to), at(settled) + 1) /
                             quantileOf(std::vector<double>(at(settled), at(end)), 0.5)};
}

double flipOf(const HoldRun& run, double ExposedError::*which) {
  std::vector<double> flips;
  for (const ExposedError& error : run.error) flips.push_back(error.*which);
  return meanOf(flips);
}

/// `heldP99Ms` is the 99th percentile of mode *hold*, flown in turns with the run.
void addRow(Table& table, const Strain& strain, const std::string& mode, double budgetMs, const HoldRun& run,
            const HoldRun& off, double heldP99Ms) {
  const std::vector<double> ms = ofStrain(run.ms, strain);
  const std::vector<std::size_t> changed = changes(run.errorPx, strain);
  const auto over = [&](double part) {
    return double(std::count_if(ms.begin(), ms.end(), [&](double m) { return m > part * budgetMs; })) /
           double(ms.size());
  };
  std::vector<double> triangles, times;
  double covered = 0;
  for (const HoldOutcome& o : run.outcomes) {
    if (o.triangles > 0) triangles.push_back(std::abs(o.predictedTriangles / o.triangles - 1));
    times.push_back(std::abs(o.predictedMs / o.ms - 1));
    covered += std::abs(o.predictedMs - o.ms) <= o.halfBandMs;
  }
  const auto orNone = [](const std::vector<double>& values, double value) {
    return values.empty() ? Cell() : Cell(value);
  };
  const double slowest = quantileOf(ofStrain(off.ms, strain), 1) / quantileOf(ms, 1);
  const Settling settling = settlingOf(run, strain);
  const double limit = quantileOf(ofStrain(run.limitMs, strain), 0.5);
  table.add(
      {{"strain", strain.name},
       {"mode", mode},
       {"budget_ms", budgetMs},
       {"frame_ms_median", quantileOf(ms, 0.5)},
       {"frame_ms_p95", quantileOf(ms, 0.95)},
       {"frame_ms_p99", quantileOf(ms, 0.99)},
       {"frame_ms_max", quantileOf(ms, 1)},
       {"slowest_gain", slowest},
       {"p99_over_budget", quantileOf(ms, 0.99) / budgetMs},
       {"share_over_1_1", over(1.1)},
       {"flip_mean", flipOf(run, &ExposedError::sharp)},
       {"flip_smeared", flipOf(run, &ExposedError::smeared)},
       {"lod_changes", double(changed.size())},
       {"lod_changes_in_1s", double(mostInASecond(changed, strain))},
       {"particles_kept", *std::min_element(run.particles.begin(), run.particles.end())},
       {"triangles_error", orNone(triangles, triangles.empty() ? 0 : quantileOf(triangles, 0.5))},
       {"ms_error", orNone(times, times.empty() ? 0 : quantileOf(times, 0.5))},
       {"band_coverage", orNone(times, times.empty() ? 0 : covered / double(times.size()))},
       {"request_ms", run.lookMs},
       {"settled_ms", std::isnan(settling.ms) ? Cell() : Cell(settling.ms)},
       {"settling_max_over_median", std::isnan(settling.ms) ? Cell() : Cell(settling.slowestOverMedian)},
       {"limit_over_budget", limit > 0 ? Cell(limit / budgetMs) : Cell()},
       {"p99_over_hold", quantileOf(ms, 0.99) / heldP99Ms}});
}

/// Plots one number of each image over the strain, one line for each mode.
Plot linesOf(const Strain& strain, const Runs& runs, std::vector<double> HoldRun::*of) {
  Plot plot;
  plot.xLabel = "time (s)";
  std::vector<double> times;
  for (const AircraftState& state : strain.states) times.push_back(state.time - strain.states[0].time);
  for (std::size_t m = 0; m < runs.size(); ++m) plot.series.push_back({kHoldModes[m], times, runs[m].*of});
  return plot;
}

void addPlots(const Strain& strain, const Runs& runs, double budgetMs, std::size_t number, Report& report) {
  const std::string file = "hold-" + std::to_string(number);
  Plot ms = linesOf(strain, runs, &HoldRun::ms);
  ms.file = file + "-frame-ms";
  ms.title = "Frame time: " + strain.name;
  ms.yLabel = "frame time (ms)";
  const std::vector<double>& times = ms.series[0].x;
  ms.series.push_back({"budget", {times.front(), times.back()}, {budgetMs, budgetMs}});
  Plot error = linesOf(strain, runs, &HoldRun::errorPx);
  error.file = file + "-error";
  error.title = "Allowed error times LOD scale: " + strain.name;
  error.yLabel = "allowed error (px)";
  Plot scale = linesOf(strain, runs, &HoldRun::renderScale);
  scale.file = file + "-render-scale";
  scale.title = "Render scale: " + strain.name;
  scale.yLabel = "render scale";
  for (Plot* plot : {&ms, &error, &scale}) report.plots.push_back(std::move(*plot));
}

/// Holds what flies, and `go`, which hears how many flights of the strain are done and what is flown.
struct Desk {
  const Stages& stages;  ///< by mode
  Referee& referee;
  const Setup& setup;
  std::function<bool(double flights, const std::string& what)> go;

  Stage& stage(HoldMode mode) const { return *stages[std::size_t(mode)]; }
};

constexpr std::size_t kFixedSettings = kFixedErrorsPx.size() * kFixedScales.size();

bool somethingFalls(const Strain& strain) {
  return std::any_of(strain.states.begin(), strain.states.end(),
                     [](const AircraftState& state) { return state.weather && state.weather->severity > 0; });
}

std::string bestNote(const Strain& strain, const std::string& best, double least, double held) {
  char text[300];
  if (best.empty())
    std::snprintf(text, sizeof text,
                  "%s: no fixed setting has a 99th percentile of at most that of hold, whose smeared FLIP is "
                  "%.4f.",
                  strain.name.c_str(), held);
  else
    std::snprintf(
        text, sizeof text,
        "%s: of fixed settings whose 99th percentile is at most that of hold in turns with them, the "
        "best is %s, smeared FLIP %.4f; hold has %.4f, %.2f of it.",
        strain.name.c_str(), best.c_str(), least, held, held / least);
  return text;
}

/// Flies fixed settings of allowed error, render scale and (where something falls) particles in turns with
/// mode *hold*, which begins with `model`, and says which loses least of those whose 99th percentile is at
/// most that of *hold*. Settings that are finer than one that is far too slow are left out.
bool addFixed(const Desk& desk, const Strain& strain, const TuningParameters& preset, std::size_t every,
              double budgetMs, const CostModel& model, const Runs& runs, Report& report) {
  const auto plain = inMode(preset, HoldMode::off, budgetMs), held = inMode(preset, HoldMode::hold, budgetMs);
  if (!plain || !held) return false;
  const std::vector<double> shares = somethingFalls(strain) ? std::vector{1.0, 0.25} : std::vector{1.0};
  const auto p99 = [&](const HoldRun& run) { return quantileOf(ofStrain(run.ms, strain), 0.99); };
  const auto median = [&](const HoldRun& run) { return quantileOf(ofStrain(run.ms, strain), 0.5); };
  double settings = 0, least = std::numeric_limits<double>::infinity();
  std::string best;
  for (const double scale : kFixedScales)
    for (const double particles : shares)
      for (const double error : kFixedErrorsPx) {
        char name[60];
        std::snprintf(name, sizeof name,
                      shares.size() > 1 ? "%g px, scale %g, particles %g" : "%g px, scale %g", error, scale,
                      particles);
        const auto go = [&](double part) {
          return desk.go(double(1 + runs.size()) + (settings + part) / double(shares.size()), name);
        };
        HoldPilot fixed(desk.stage(HoldMode::off), desk.referee, desk.setup,
                        {*plain, HeldLevers{error, scale, particles, 1}, every}, strain, {});
        HoldPilot holds(desk.stage(HoldMode::hold), desk.referee, desk.setup, {*held, std::nullopt, 0},
                        strain, model);
        HoldPilot* const both[] = {&fixed, &holds};
        const auto pair = flyInTurns(both, strain, go);
        if (!pair) return false;
        ++settings;
        const HoldRun& run = (*pair)[0];
        const double heldMs = p99((*pair)[1]), flip = flipOf(run, &ExposedError::smeared);
        addRow(report.measured, strain, name, budgetMs, run, runs[0], heldMs);
        if (p99(run) <= heldMs && flip < least) least = flip, best = name;
        if (p99(run) > kFarTooSlow * heldMs && median(run) > kFarTooSlow * median((*pair)[1])) break;
      }
  const HoldRun& hold = runs[std::size_t(HoldMode::hold)];
  report.notes.push_back(bestNote(strain, best, least, flipOf(hold, &ExposedError::smeared)));
  return true;
}

std::string lossNote(const Strain& strain, const HoldParameters& hold) {
  char text[240];
  std::snprintf(text, sizeof text,
                "%s: the arbiter counts a mean FLIP of %.4f lost at 16 px, %.4f at half the render scale and "
                "%.4f without particles, measured on other images of the strain.",
                strain.name.c_str(), hold.lossError.value(), hold.lossRenderScale.value(),
                hold.lossParticles.value());
  return text;
}

/// Flies the strain in all modes, each with a renderer of its own. `model` is what mode *hold* begins with,
/// and learns.
Result<Runs> flyModes(const Desk& desk, const Strain& strain, const TuningParameters& preset,
                      std::size_t every, double budgetMs, CostModel& model) {
  std::array<std::unique_ptr<HoldPilot>, kHoldModes.size()> pilots;
  std::array<HoldPilot*, kHoldModes.size()> inTurns{};
  for (std::size_t m = 0; m < pilots.size(); ++m) {
    const auto mode = static_cast<HoldMode>(m);
    const Result<ValidatedParameters> parameters = inMode(preset, mode, budgetMs);
    if (!parameters) return parameters.findings();
    pilots[m] = std::make_unique<HoldPilot>(desk.stage(mode), desk.referee, desk.setup,
                                            HoldFlight{*parameters, std::nullopt, every}, strain,
                                            mode == HoldMode::hold ? model : CostModel{});
    inTurns[m] = pilots[m].get();
  }
  auto flown = flyInTurns(inTurns, strain, [&](double part) {
    return desk.go(1 + part * double(pilots.size()), "all modes in turns");
  });
  if (!flown) return cancelled();
  Runs runs;
  std::move(flown->begin(), flown->end(), runs.begin());
  model = pilots[std::size_t(HoldMode::hold)]->model();
  return runs;
}

/// 2,000 ft above a place.
GeodeticPosition eyeAbove(const Place& place) {
  GeodeticPosition eye = place.ground;
  eye.height = eye.height + Feet{2000}.as<Metres>();
  return eye;
}

/// Returns what a program would load at its start: the model after a sweep from another place than that of
/// the strains. Returns nothing if the person cancels.
std::optional<CostModel> learned(const Desk& desk) {
  const std::vector<Place> places = placesOf(desk.setup, 3);
  const auto parameters =
      inMode(desk.setup.parameters, HoldMode::hold, desk.setup.parameters.measure.budget.value());
  if (places.empty() || !parameters) return CostModel{};
  const Strain strain = sweepStrain(eyeAbove(places.back()));
  HoldPilot pilot(desk.stage(HoldMode::hold), desk.referee, desk.setup, {*parameters, std::nullopt, 0},
                  strain, {});
  if (!fly(pilot, strain, [&](double) { return desk.go(0, "to learn what images cost"); })) return {};
  return pilot.model();
}

/// Returns the strains that the terrain, the flight and the head allow.
Result<std::vector<Strain>> strainsOf(const Setup& setup, std::vector<std::string>& notes) {
  std::vector<Strain> strains;
  const std::vector<Place> places = placesOf(setup, 1);
  if (places.empty()) return notOverTerrain(setup);
  strains.push_back(sweepStrain(eyeAbove(places[0])));
  const Result<HeadLog> builtIn = parseSweep(kBuiltInHead);
  if (!setup.hold.head && !builtIn) return builtIn.findings();
  const HeadLog& head = setup.hold.head ? *setup.hold.head : *builtIn;
  const double seconds = setup.hold.flightS;
  for (const std::optional<Strain>& strain :
       {headStrain(setup, head, seconds), weatherStrain(setup, head, seconds), steadyStrain(setup, seconds)})
    if (strain) strains.push_back(*strain);
  char text[120];
  std::snprintf(text, sizeof text,
                "Without a flight over the terrain for %g s in its middle only the sweep was flown.",
                seconds);
  if (strains.size() == 1) notes.push_back(text);
  std::erase_if(strains, [&](const Strain& strain) {
    return strain.name.find(setup.hold.strain) == std::string::npos;
  });
  if (strains.empty())
    return Finding{Severity::error, "strain", {}, "a flight over the terrain for so many seconds", text};
  return strains;
}

}  // namespace

Result<Report> runHold(const Setup& setup) {
  Stages stages;
  for (std::unique_ptr<Stage>& stage : stages) {
    auto opened = Stage::open(setup);
    if (!opened) return opened.findings();
    stage = std::move(opened).value();
  }
  const auto referee = Referee::open(setup);
  if (!referee) return referee.findings();
  Report report{"hold", "C, D: what is left open", stages[0]->machine(), {}, {}, {}, {}};
  const Result<std::vector<Strain>> strains = strainsOf(setup, report.notes);
  if (!strains) return strains.findings();
  const auto first = learned({stages, **referee, setup, [&](double, const std::string& what) {
                                return !setup.progress || setup.progress(0, what);
                              }});
  if (!first) return cancelled();
  CostModel model = *first;
  const double most = double(1 + kHoldModes.size() + (setup.hold.fixedSettings ? kFixedSettings : 0));
  for (std::size_t s = 0; s < strains->size(); ++s) {
    const Strain& strain = (*strains)[s];
    TuningParameters preset = setup.parameters;
    double budgetMs = preset.measure.budget.value();
    const auto plain = inMode(preset, HoldMode::off, budgetMs);
    if (!plain) return plain.findings();
    measureLosses((*referee)->meter(), setup, *plain, strain, preset.hold);
    report.notes.push_back(lossNote(strain, preset.hold));
    const std::size_t every = (strain.to - strain.from + kMeasured - 1) / kMeasured;
    const Desk desk{stages, **referee, setup, [&](double flights, const std::string& what) {
                      return !setup.progress ||
                             setup.progress((double(s) + flights / most) / double(strains->size()),
                                            strain.name + ", " + what);
                    }};
    if (setup.hold.budgetMs) {
      budgetMs = *setup.hold.budgetMs;
    } else {
      HoldPilot pilot(*stages[0], **referee, setup, {*plain, std::nullopt, 0}, strain, {});
      const auto run = fly(pilot, strain, [&](double part) { return desk.go(part, "to find the budget"); });
      if (!run) return cancelled();
      budgetMs = kHeldPart * quantileOf(ofStrain(run->ms, strain), 0.5);
    }
    const CostModel before = model;
    const Result<Runs> flown = flyModes(desk, strain, preset, every, budgetMs, model);
    if (!flown) return flown.findings();
    const Runs& runs = *flown;
    for (std::size_t m = 0; m < runs.size(); ++m)
      addRow(report.measured, strain, kHoldModes[m], budgetMs, runs[m], runs[0],
             quantileOf(ofStrain(runs[std::size_t(HoldMode::hold)].ms, strain), 0.99));
    if (setup.hold.fixedSettings && !addFixed(desk, strain, preset, every, budgetMs, before, runs, report))
      return cancelled();
    addPlots(strain, runs, budgetMs, s + 1, report);
  }
  char budget[60];
  if (setup.hold.budgetMs)
    std::snprintf(budget, sizeof budget, "%g ms", *setup.hold.budgetMs);
  else
    std::snprintf(budget, sizeof budget, "%g of the median image of mode off", kHeldPart);
  char text[1200];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d. The budget is %s. Work time of each image, the modes in turns image by image, "
      "each with a renderer of its own that builds ahead between images and waits for no page; FLIP of %zu "
      "images, with all pages, against the finest levels, flip_smeared with both smeared by the exposure. "
      "slowest_gain is the slowest image of off over that of the mode. lod_changes_in_1s are the most "
      "changes in any second. settled_ms is the time from the end of the strain until the levers stay. The "
      "model of hold has flown a sweep from another place before. Each fixed setting flies in turns with "
      "hold, which p99_over_hold compares it with; those finer than one that is far too slow are left "
      "out.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, budget, kMeasured);
  report.notes.insert(report.notes.begin(), text);
  return report;
}

}  // namespace trimtab::experiment
