#include "run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/experiment/stage.h"
#include "decided_frames.h"
#include "report.h"
#include "skips.h"
#include "store.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/preset/choices.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/scene/gl_report.h"
#include "worst_frames.h"

namespace trimtab::harness {
namespace {

using experiment::quantileOf;
using experiment::Stage;
using Clock = std::chrono::steady_clock;

/// Draws a frame whose parts are told apart by waiting: they cost time, so these are not the timed ones.
constexpr std::size_t kPartDraws = 3;
/// Pairs of a frame and the one before it that the savings of skips are measured on.
constexpr std::size_t kSkipFrames = 8;
/// Draws that a frame's errors and its skips' savings take besides the timed ones; only for the time left.
constexpr std::size_t kErrorDraws = 12, kSkipDraws = 60;

/// One preset in one case, with the frames of the flight in hand.
struct Runner {
  UnitName name;
  std::vector<DecidedFrame> frames;
};

/// What was measured of one frame.
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

TraceCounts countsOf(const VisibleSet& visible) {
  return {visible.triangles, visible.vertices,         visible.tiles.size(), visible.outsideFrustum,
          visible.occluded,  visible.beyondVisibility, visible.backFacing};
}

/// What is drawn must not depend on what was drawn before, nor on where a run was taken up again.
FrameRequest alone(FrameRequest request) {
  request.skips.littleHidden = false;
  return request;
}

std::string aboutText(double seconds) {
  char text[48];
  if (seconds < 90)
    std::snprintf(text, sizeof text, "about %.0f s left", std::ceil(seconds));
  else
    std::snprintf(text, sizeof text, "about %.0f min left", std::ceil(seconds / 60));
  return text;
}

class Run {
 public:
  Run(const Plan& plan, Stage& stage, scene::ErrorMeter& meter, const Store& store)
      : plan_(plan), stage_(stage), meter_(meter), store_(store) {}

  Result<Results> all();

 private:
  Findings measureFlight(std::size_t flight, Results& results);
  std::vector<Unit> measureFrame(const std::vector<Runner>& runners, std::size_t index);
  Findings keepWorst(const std::vector<Runner>& runners, std::size_t unitsBefore, std::vector<Unit>& units);
  Findings measureSkipsOf(std::size_t flight, const std::vector<Runner>& runners, std::vector<Unit>& units);
  std::vector<Runner> runnersOf(const Plan::NamedFlight& flight, const std::vector<std::size_t>& rows);
  bool goOn();
  void finished(std::size_t draws, bool byThisRun);
  Finding stopped() const;
  std::size_t units() const { return plan_.presets.size() * plan_.cases.size(); }
  std::size_t drawsOfFrame() const { return units() * (kErrorDraws + 2 * plan_.repeats); }
  std::size_t drawsOfSkips() const { return plan_.skips ? kSkipDraws * plan_.repeats : 0; }

  const Plan& plan_;
  Stage& stage_;
  scene::ErrorMeter& meter_;
  const Store& store_;
  std::vector<std::vector<std::size_t>> rows_;  ///< sampled, by flight
  std::size_t frames_ = 0, framesDone_ = 0;
  std::size_t work_ = 0, done_ = 0, measured_ = 0;  ///< in draws, roughly; `measured_` by this run
  Clock::time_point start_ = Clock::now();
  std::string doing_;
  bool cancelled_ = false;
  MachineWatch watch_;
};

bool Run::goOn() {
  if (!plan_.progress || cancelled_) return !cancelled_;
  std::string what = doing_;
  if (measured_ > 0) {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    what += ", " + aboutText(seconds / static_cast<double>(measured_) * static_cast<double>(work_ - done_));
  }
  const double fraction = static_cast<double>(done_) / static_cast<double>(std::max<std::size_t>(work_, 1));
  cancelled_ = !plan_.progress(fraction, what);
  return !cancelled_;
}

void Run::finished(std::size_t draws, bool byThisRun) {
  done_ += draws;
  if (byThisRun) measured_ += draws;
}

Finding Run::stopped() const {
  return {Severity::error, store_.folder().string(), "", "to run to its end",
          "it was cancelled; " + std::to_string(framesDone_) + " of " + std::to_string(frames_) +
              " frames are there, and the same command goes on from them"};
}

std::vector<Runner> Run::runnersOf(const Plan::NamedFlight& flight, const std::vector<std::size_t>& rows) {
  std::vector<Runner> runners;
  for (const auto& preset : plan_.presets)
    for (const CullingCase method : plan_.cases) {
      TuningParameters parameters = *preset.parameters;
      parameters.culling.method = method;
      const auto valid = validate(parameters);
      // The case is free of rules; a set that was valid stays so.
      if (!valid) continue;
      runners.push_back({{flight.name, preset.name, std::string(caseName(method))},
                         decideFrames(plan_, flight, *valid, rows)});
    }
  return runners;
}

std::vector<Unit> Run::measureFrame(const std::vector<Runner>& runners, std::size_t index) {
  std::vector<Unit> units;
  for (const Runner& runner : runners) {
    if (!goOn()) return {};
    const DecidedFrame& frame = runner.frames[index];
    MeasuredFrame measured;
    measured.row = frame.row;
    measured.timeS = frame.timeS;
    measured.error = meter_.measure(frame.request, frame.before, nullptr);
    // What the step from the row before pages in, with nothing there but that row's.
    stage_.setTerrain(plan_.terrain);
    if (!frame.before.empty()) stage_.draw(frame.before.back());
    const FrameResult first = stage_.draw(alone(frame.request));
    measured.counts = countsOf(first.visible);
    measured.cost.page = first.cost.page;
    Unit unit;
    unit.name = runner.name;
    unit.frames.push_back(std::move(measured));
    units.push_back(std::move(unit));
  }
  const std::size_t n = runners.size();
  std::vector<std::vector<FrameCost>> costs(n), parts(n);
  // A frame that is drawn again finds what was made for the eye's place; after the one before it, it does
  // the work that a flight asks of it.
  const auto inFlight = [this](const DecidedFrame& frame, bool separateStages) {
    if (!frame.before.empty()) stage_.draw(frame.before.back());
    FrameRequest request = frame.request;
    request.separateStages = separateStages;
    return stage_.draw(request).cost;
  };
  for (const Runner& runner : runners) inFlight(runner.frames[index], false);
  for (std::size_t repeat = 0; repeat < plan_.repeats; ++repeat)
    for (std::size_t i = 0; i < n; ++i) {
      // Nobody is always first.
      const std::size_t u = (i + repeat + index) % n;
      costs[u].push_back(inFlight(runners[u].frames[index], false));
    }
  for (std::size_t u = 0; u < n; ++u) {
    const DecidedFrame& frame = runners[u].frames[index];
    MeasuredFrame& measured = units[u].frames.front();
    const double page = measured.cost.page;
    for (FrameCost& cost : costs[u]) {
      cost.decide = frame.decideMs;
      cost.total += frame.decideMs;
      measured.repeatsMs.push_back(cost.total);
    }
    measured.cost = medians(costs[u]);
    measured.cost.page = page;
    for (std::size_t i = 0; i < std::min(plan_.repeats, kPartDraws); ++i)
      parts[u].push_back(inFlight(frame, true));
    const FrameCost ofParts = medians(parts[u]);
    for (const CostStage& stage : kCostStages)
      if (stage.kind == StageKind::part && std::isnan(measured.cost.*stage.ms))
        measured.cost.*stage.ms = ofParts.*stage.ms;
  }
  return units;
}

Findings Run::keepWorst(const std::vector<Runner>& runners, std::size_t unitsBefore,
                        std::vector<Unit>& units) {
  for (std::size_t u = 0; u < units.size(); ++u) {
    units[u].worst = worstFrames(units[u], unitsBefore + u + 1, plan_.worst);
    for (const WorstFrame& worst : units[u].worst) {
      doing_ = "pictures of " + units[u].name.flight + ", " + units[u].name.preset;
      if (!goOn()) return {stopped()};
      const DecidedFrame& frame = runners[u].frames[worst.frame];
      scene::ErrorPictures pictures;
      meter_.measure(frame.request, frame.before, &pictures);
      if (const auto written = writePictures(worst, pictures, store_.folder()); !written)
        return store_.needs(written.findings(), pictures.ours.size());
    }
  }
  return {};
}

/// Each frame after the one before it, because what a frame may leave out the one before it decides.
Findings Run::measureSkipsOf(std::size_t flight, const std::vector<Runner>& runners,
                             std::vector<Unit>& units) {
  std::optional<std::vector<Unit>> held = store_.skips(flight);
  if (held && held->size() == units.size()) {
    finished(drawsOfSkips() * units.size(), false);
  } else {
    held.emplace();
    const auto draw = [this](const FrameRequest& request) { return stage_.draw(request); };
    stage_.setTerrain(plan_.terrain);
    for (const Runner& runner : runners) {
      doing_ = "what skips save, " + runner.name.preset + ", " + runner.name.method;
      if (!goOn()) return {stopped()};
      std::vector<FrameRequest> frames;
      const std::size_t count = std::min(kSkipFrames, runner.frames.size());
      for (std::size_t k = 0; k < count; ++k) {
        const DecidedFrame& frame = runner.frames[(2 * k + 1) * runner.frames.size() / (2 * count)];
        frames.push_back(frame.before.empty() ? frame.request : frame.before.back());
        frames.push_back(frame.request);
      }
      Unit unit;
      unit.name = runner.name;
      unit.skips = measureSkips(
          draw, frames, plan_.repeats, [this] { return goOn(); }, true);
      held->push_back(std::move(unit));
      finished(drawsOfSkips(), true);
    }
    if (cancelled_) return {stopped()};
    if (const auto written = store_.writeSkips(flight, *held); !written) return written.findings();
  }
  for (std::size_t u = 0; u < units.size(); ++u) units[u].skips = (*held)[u].skips;
  return {};
}

Findings Run::measureFlight(std::size_t flight, Results& results) {
  const auto& named = plan_.flights[flight];
  const std::vector<std::size_t>& rows = rows_[flight];
  const std::vector<Runner> runners = runnersOf(named, rows);
  std::vector<Unit> units;
  for (const Runner& runner : runners) {
    Unit unit;
    unit.name = runner.name;
    unit.framesDecided = named.flight.states.size();
    units.push_back(std::move(unit));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    doing_ = named.name + ", frame " + std::to_string(i + 1) + " of " + std::to_string(rows.size());
    std::optional<std::vector<Unit>> part = store_.frame(flight, rows[i]);
    const bool whole =
        part && part->size() == units.size() &&
        std::all_of(part->begin(), part->end(), [](const Unit& u) { return u.frames.size() == 1; });
    if (!whole) {
      part = measureFrame(runners, i);
      if (cancelled_) return {stopped()};
      if (const auto written = store_.writeFrame(flight, rows[i], *part); !written) return written.findings();
    }
    for (std::size_t u = 0; u < units.size(); ++u)
      units[u].frames.push_back(std::move((*part)[u].frames.front()));
    ++framesDone_;
    finished(drawsOfFrame(), !whole);
    if (!goOn()) return {stopped()};
  }
  if (Findings failed = keepWorst(runners, results.units.size(), units); !failed.empty()) return failed;
  if (plan_.skips)
    if (Findings failed = measureSkipsOf(flight, runners, units); !failed.empty()) return failed;
  for (Unit& unit : units) results.units.push_back(std::move(unit));
  return {};
}

Result<Results> Run::all() {
  Results results;
  results.terrain = plan_.terrainName;
  results.machine = stage_.machine();
  results.version = plan_.version;
  results.widthPx = plan_.widthPx;
  results.heightPx = plan_.heightPx;
  results.repeats = plan_.repeats;
  results.budgetMs = plan_.presets.front().parameters->measure.budget.value();
  results.notes = {
      "Time is stepped from the flight's rows, pages are waited for and no measured cost reaches a decision: "
      "errors and counts repeat exactly.",
      "Frame times are medians of " + std::to_string(plan_.repeats) +
          (plan_.repeats == 1 ? " draw" : " draws") +
          " of a frame after the row before it, with its pages there; all presets and cases take turns "
          "frame by frame. Page is what the step from the row before would add."};
  const TerrainForm form = plan_.presets.front().parameters->staticLod.terrain;
  for (const auto& preset : plan_.presets)
    if (preset.parameters->staticLod.terrain != form && plan_.terrain->staticLod())
      results.notes.push_back(preset.name + " draws another form of the terrain than " +
                              plan_.presets.front().name +
                              ": each is held against the finest levels of its own.");
  Findings failed;
  for (const auto& flight : plan_.flights) {
    rows_.push_back(sampledRows(flight.flight, *plan_.terrain, plan_.frames));
    if (rows_.back().empty())
      failed.push_back({Severity::error, flight.name, "", "a flight over the terrain " + plan_.terrainName,
                        "none of its " + std::to_string(flight.flight.states.size()) + " rows lies over it"});
    frames_ += rows_.back().size();
    work_ += rows_.back().size() * drawsOfFrame() + units() * drawsOfSkips();
    if (!flight.trace.empty())
      results.notes.push_back(flight.name + " is a trace: its recorded cost is replayed.");
  }
  if (!failed.empty()) return failed;
  for (std::size_t flight = 0; flight < plan_.flights.size(); ++flight)
    if (failed = measureFlight(flight, results); !failed.empty()) return failed;
  // Images of what the terrain did not hold are no measurement.
  if (failed = plan_.terrain->damage(); !failed.empty()) return failed;
  results.othersShare = watch_.othersShare();
  results.comparisons = compareUnits(results.units);
  if (const auto done = store_.write("frames.csv", toCsv(results)); !done) return done.findings();
  if (const auto done = store_.write("results.json", toJson(results)); !done) return done.findings();
  if (const auto done = writeReport(results, store_.folder()); !done) return done.findings();
  return results;
}

Findings faultsOf(const Plan& plan) {
  Findings faults;
  const auto need = [&faults](bool good, const char* what, const std::string& expected,
                              const std::string& found) {
    if (!good) faults.push_back({Severity::error, what, "", expected, found});
  };
  need(plan.terrain != nullptr, "terrain", "a database", "none");
  need(!plan.flights.empty(), "flights", "at least one", "none");
  need(!plan.presets.empty(), "presets", "at least one", "none");
  need(!plan.cases.empty(), "cases", "at least one", "none");
  need(plan.frames > 0, "frames", "at least one", "0");
  need(plan.repeats > 0, "repeats", "at least one", "0");
  need(plan.widthPx > 0 && plan.heightPx > 0, "size", "pixels both ways",
       std::to_string(plan.widthPx) + "x" + std::to_string(plan.heightPx));
  for (const auto& flight : plan.flights)
    need(flight.trace.empty() || flight.trace.size() == flight.flight.states.size(), "trace",
         "a row for each of the flight's " + std::to_string(flight.flight.states.size()),
         std::to_string(flight.trace.size()));
  // Names tell units apart.
  const auto unique = [&need](const auto& list, const char* what, const auto& nameOf) {
    for (auto a = list.begin(); a != list.end(); ++a)
      for (auto b = list.begin(); b != a; ++b)
        need(nameOf(*a) != nameOf(*b), what, "each once", std::string(nameOf(*a)) + " twice");
  };
  unique(plan.flights, "flights", [](const auto& f) { return f.name; });
  unique(plan.presets, "presets", [](const auto& p) { return p.name; });
  unique(plan.cases, "cases", [](CullingCase method) { return caseName(method); });
  return faults;
}

}  // namespace

std::string_view caseName(CullingCase method) {
  return table::ChoicesOf<CullingCase>::options[static_cast<std::size_t>(method)].name;
}

Result<Results> run(const Plan& plan, const std::filesystem::path& folder) {
  if (Findings faults = faultsOf(plan); !faults.empty()) return faults;
  experiment::Setup setup;
  setup.terrain = plan.terrain;
  setup.widthPx = plan.widthPx;
  setup.heightPx = plan.heightPx;
  const auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  const auto store = Store::open(folder, plan, (*stage)->machine());
  if (!store) return store.findings();
  scene::ErrorMeter meter;
  if (const scene::GlReport gl = meter.initialize(); !gl.usable)
    return Finding{Severity::error, "OpenGL", {}, "what the renderer needs", gl.missing};
  meter.setTerrain(plan.terrain);
  Result<Results> results = Run(plan, **stage, meter, *store).all();
  meter.release();
  return results;
}

}  // namespace trimtab::harness
