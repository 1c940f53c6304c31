#include "run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/experiment/stage.h"
#include "frame_meter.h"
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
#include "trimtab/scene/osg_database.h"
#include "worst_frames.h"

namespace trimtab::harness {
namespace {

using experiment::quantileOf;
using experiment::Stage;
using Clock = std::chrono::steady_clock;

/// Pairs of a frame and the one before it that the savings of skips are measured on.
constexpr std::size_t kSkipFrames = 8;
/// Draws that a frame's errors and its skips' savings take besides the timed ones; only for the time left.
constexpr std::size_t kErrorDraws = 12, kSkipDraws = 60;

/// Keeps the keys that the frame's part has as well.
void keepCommon(std::vector<std::string>& keys, const std::vector<std::string>& others) {
  std::erase_if(keys, [&others](const std::string& key) {
    return std::find(others.begin(), others.end(), key) == others.end();
  });
}

Finding unknownFinding(const UnitName& unit, const std::string& key) {
  const std::optional<Signal> signal = signalNamed(key);
  return {Severity::warning, unit.flight + ", " + unit.preset + ", " + unit.method, key,
          "a signal that is known in at least one measured frame, because rules ask for it",
          "none, so that these rules never fired: it is unknown if " +
              std::string(signal ? rowOf(*signal).unknown : std::string_view("nobody derives it"))};
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
  Findings keepWorst(std::size_t flight, std::vector<Runner>& runners, std::size_t unitsBefore,
                     std::vector<Unit>& units);
  Findings measureSkipsOf(std::size_t flight, std::vector<Runner>& runners, std::vector<Unit>& units);
  std::vector<Runner> runnersOf(const Plan::NamedFlight& flight) const;
  bool fly(std::size_t flight, std::vector<Runner>& runners);
  std::size_t imagesOf(std::size_t flight, const std::vector<Runner>& runners) const;
  std::vector<std::string> notesOnFeedback() const;
  bool goOn();
  void finished(std::size_t draws, bool byThisRun);
  Finding stopped() const;
  std::size_t units() const { return plan_.presets.size() * plan_.cases.size(); }
  Flying flying() const {
    return {plan_.terrain, plan_.widthPx, plan_.heightPx, plan_.whole, plan_.repeats, {}};
  }
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
  std::size_t missing_ = 0;  ///< frames of other parts that are not there yet
  std::filesystem::path firstMissing_;
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
  const Clock::time_point asked = Clock::now();
  cancelled_ = !plan_.progress(fraction, what);
  // The program may have been paused there.
  start_ += Clock::now() - asked;
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

std::vector<Runner> Run::runnersOf(const Plan::NamedFlight& flight) const {
  std::vector<Runner> runners;
  for (const auto& preset : plan_.presets)
    for (const CullingCase method : plan_.cases) {
      TuningParameters parameters = *preset.parameters;
      parameters.culling.cullingCase = method;
      const auto valid = validate(parameters);
      // The case is free of rules; a set that was valid stays so.
      if (!valid) continue;
      runners.push_back({{flight.name, preset.name, std::string(caseName(method))}, *valid, {}});
    }
  return runners;
}

std::size_t Run::imagesOf(std::size_t flight, const std::vector<Runner>& runners) const {
  std::size_t images = 0;
  for (const Runner& runner : runners)
    images += imagesToFly(flying(), plan_.flights[flight].flight, runner.parameters, rows_[flight]);
  return images;
}

/// Flies all presets, unless they have flown already; false if it was cancelled.
bool Run::fly(std::size_t flight, std::vector<Runner>& runners) {
  const auto& named = plan_.flights[flight];
  for (Runner& runner : runners) {
    if (!runner.frames.empty()) continue;
    // Nobody flies over pages that another one has read.
    stage_.setTerrain(plan_.terrain);
    doing_ = "flying " + named.name + ", " + runner.name.preset + ", " + runner.name.method;
    if (!goOn()) return false;
    Flying how = flying();
    how.goOn = [this] {
      finished(1, true);
      return goOn();
    };
    auto frames = flyFrames(stage_, how, named.flight, runner.parameters, rows_[flight]);
    if (!frames) return false;
    runner.frames = *std::move(frames);
  }
  return true;
}

Findings Run::keepWorst(std::size_t flight, std::vector<Runner>& runners, std::size_t unitsBefore,
                        std::vector<Unit>& units) {
  for (std::size_t u = 0; u < units.size(); ++u) {
    units[u].worst = worstFrames(units[u], unitsBefore + u + 1, plan_.worst);
    for (const WorstFrame& worst : units[u].worst) {
      if (havePictures(worst, store_.folder())) continue;
      if (!fly(flight, runners)) return {stopped()};
      doing_ = "pictures of " + units[u].name.flight + ", " + units[u].name.preset;
      if (!goOn()) return {stopped()};
      const FlownFrame::Image& image = runners[u].frames[worst.frame].ofRepeat(0);
      scene::ErrorPictures pictures;
      meter_.measure(image.request, image.before, &pictures);
      if (const auto written = writePictures(worst, pictures, store_.folder()); !written)
        return store_.needs(written.findings(), pictures.ours.size());
    }
  }
  return {};
}

/// Each frame after the one before it, because what a frame may leave out the one before it decides.
Findings Run::measureSkipsOf(std::size_t flight, std::vector<Runner>& runners, std::vector<Unit>& units) {
  std::optional<std::vector<Unit>> held = store_.skips(flight);
  if (held && held->size() == units.size()) {
    finished(drawsOfSkips() * units.size(), false);
  } else {
    held.emplace();
    if (!fly(flight, runners)) return {stopped()};
    const auto draw = [this](const FrameRequest& request) { return stage_.draw(request); };
    stage_.setTerrain(plan_.terrain);
    for (const Runner& runner : runners) {
      doing_ = "what skips save, " + runner.name.preset + ", " + runner.name.method;
      if (!goOn()) return {stopped()};
      std::vector<FrameRequest> frames;
      const std::size_t count = std::min(kSkipFrames, runner.frames.size());
      for (std::size_t k = 0; k < count; ++k) {
        const FlownFrame::Image& image =
            runner.frames[(2 * k + 1) * runner.frames.size() / (2 * count)].ofRepeat(0);
        frames.push_back(image.before.empty() ? image.request : image.before.back());
        frames.push_back(image.request);
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
  std::vector<Runner> runners = runnersOf(named);
  std::vector<Unit> units;
  for (const Runner& runner : runners) {
    Unit unit;
    unit.name = runner.name;
    unit.framesDecided = named.flight.states.size();
    units.push_back(std::move(unit));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string doing =
        named.name + ", frame " + std::to_string(i + 1) + " of " + std::to_string(rows.size());
    doing_ = doing;
    std::optional<std::vector<Unit>> part = store_.frame(flight, rows[i]);
    const bool whole =
        part && part->size() == units.size() &&
        std::all_of(part->begin(), part->end(), [](const Unit& u) { return u.frames.size() == 1; });
    if (!whole && plan_.part && i % plan_.part->count != plan_.part->index) {
      if (missing_++ == 0) firstMissing_ = store_.fileOf(flight, rows[i]);
      continue;
    }
    if (!whole) {
      if (!fly(flight, runners)) return {stopped()};
      doing_ = doing;
      part = measureFrame(stage_, meter_, plan_, runners, i, [this] { return goOn(); });
      if (!part) return {stopped()};
      if (const auto written = store_.writeFrame(flight, rows[i], *part); !written) return written.findings();
    }
    for (std::size_t u = 0; u < units.size(); ++u) {
      Unit &unit = units[u], &more = (*part)[u];
      unit.frames.push_back(std::move(more.frames.front()));
      if (i == 0)
        unit.unknownSignals = std::move(more.unknownSignals);
      else
        keepCommon(unit.unknownSignals, more.unknownSignals);
    }
    ++framesDone_;
    finished(drawsOfFrame(), !whole);
    if (!goOn()) return {stopped()};
  }
  if (missing_ > 0) return {};
  if (Findings failed = keepWorst(flight, runners, results.units.size(), units); !failed.empty())
    return failed;
  if (plan_.skips)
    if (Findings failed = measureSkipsOf(flight, runners, units); !failed.empty()) return failed;
  if (runners.front().frames.empty()) finished(imagesOf(flight, runners), false);
  for (Unit& unit : units) results.units.push_back(std::move(unit));
  return {};
}

/// Returns which presets were given what of their own images.
std::vector<std::string> Run::notesOnFeedback() const {
  std::vector<std::string> notes;
  for (const auto& preset : plan_.presets) {
    const Feedback feedback = feedbackOf(preset.parameters);
    if (!feedback.any()) continue;
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.1f s", feedback.rememberedS);
    std::string note = preset.name + " decides by its own images: " +
                       (plan_.whole ? "all of them are drawn."
                                    : std::string("those of ") + seconds + ", and at least " +
                                          std::to_string(feedback.rememberedImages) +
                                          ", are drawn before each measured one.");
    if (feedback.times)
      note +=
          " Time is among what it decides by, so that each repeat flies anew. Its errors and counts are "
          "means of the repeats, and two runs differ.";
    notes.push_back(std::move(note));
  }
  return notes;
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
      "Each preset decides every row of a flight in order. Time is stepped from the rows and pages are "
      "waited "
      "for: errors and counts repeat exactly where no decision depends on measured time.",
      "Frame times are medians of " + std::to_string(plan_.repeats) +
          (plan_.repeats == 1 ? " draw" : " draws") +
          " of a frame after the row before it, with its pages there; all presets and cases take turns "
          "frame by frame. Page is what the step from the row before would add."};
  for (std::string& note : notesOnFeedback()) results.notes.push_back(std::move(note));
  const TerrainForm form = plan_.presets.front().parameters->terrain.form;
  for (const auto& preset : plan_.presets)
    if (preset.parameters->terrain.form != form && plan_.terrain->staticLod())
      results.notes.push_back(preset.name + " draws another form of the terrain than " +
                              plan_.presets.front().name +
                              ": each is held against the finest levels of its own.");
  if (plan_.cases.size() > 1 && dynamic_cast<const scene::OsgDatabase*>(plan_.terrain.get()) != nullptr)
    results.notes.push_back(
        "OpenSceneGraph culls its scene itself: all cases of culling draw the same image, and differences "
        "between their times are noise.");
  Findings failed;
  for (const auto& flight : plan_.flights) {
    rows_.push_back(plan_.rows.empty() ? sampledRows(flight.flight, *plan_.terrain, plan_.frames)
                                       : plan_.rows[rows_.size()]);
    if (rows_.back().empty())
      failed.push_back({Severity::error, flight.name, "", "a flight over the terrain " + plan_.terrainName,
                        "none of its " + std::to_string(flight.flight.states.size()) + " rows lies over it"});
    frames_ += rows_.back().size();
    work_ += rows_.back().size() * drawsOfFrame() + units() * drawsOfSkips();
  }
  if (!failed.empty()) return failed;
  for (std::size_t flight = 0; flight < plan_.flights.size(); ++flight)
    work_ += imagesOf(flight, runnersOf(plan_.flights[flight]));
  for (std::size_t flight = 0; flight < plan_.flights.size(); ++flight)
    if (failed = measureFlight(flight, results); !failed.empty()) return failed;
  if (missing_ > 0) {
    Results none;
    none.notes.push_back(std::to_string(missing_) + " frames of other parts are missing, the first " +
                         firstMissing_.string());
    return none;
  }
  // Images of what the terrain did not hold are no measurement.
  if (failed = plan_.terrain->damage(); !failed.empty()) return failed;
  Findings unknown;
  for (const Unit& unit : results.units)
    for (const std::string& key : unit.unknownSignals) unknown.push_back(unknownFinding(unit.name, key));
  for (const Finding& finding : unknown)
    results.notes.push_back(finding.where + ": nobody knew the signal " + finding.key + "; " + finding.found);
  results.othersShare = watch_.othersShare();
  results.comparisons = compareUnits(results.units);
  if (const auto done = store_.write("frames.csv", toCsv(results)); !done) return done.findings();
  if (const auto done = store_.write("results.json", toJson(results)); !done) return done.findings();
  if (const auto done = writeReport(results, store_.folder()); !done) return done.findings();
  return {std::move(results), std::move(unknown)};
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
  need(plan.rows.empty() || plan.rows.size() == plan.flights.size(), "rows", "those of each flight",
       std::to_string(plan.rows.size()) + " lists");
  need(plan.repeats > 0, "repeats", "at least one", "0");
  need(plan.widthPx > 0 && plan.heightPx > 0, "size", "pixels both ways",
       std::to_string(plan.widthPx) + "x" + std::to_string(plan.heightPx));
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
