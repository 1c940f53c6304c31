#include "tune.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "app/harness/flown_frames.h"
#include "app/harness/run_plan.h"
#include "candidates.h"
#include "run_folder.h"
#include "search_space.h"
#include "tried.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/preset/preset.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"
#include "verdict.h"

namespace trimtab::tune {
namespace {

using Clock = std::chrono::steady_clock;

/// How much of a run's time its steps take, for its progress.
constexpr double kSamplesPart = 0.2, kSearchPart = 0.3, kTriedPart = 0.45;
/// So many presets are tried out for each that is measured, and so much of them is drawn.
constexpr std::size_t kTriedForOne = 2, kTriedFrames = 8, kTriedRepeats = 2;
/// Estimates miss by up to a third, so presets so far from the limit are tried out; corrected ones by less.
constexpr double kTriedFrom = 0.7, kTriedTo = 1.3, kMeasuredFrom = 0.8, kMeasuredTo = 1.05;

Finding fault(const char* what, std::string expected, std::string found) {
  return {Severity::error, what, "", std::move(expected), std::move(found)};
}

std::string rangeText(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  return numberText(least, 3) + " to " + numberText(most, 3);
}

/// Returns parameters with the budget of the plan, which they hold and load is counted in.
ValidatedParameters withBudgetOf(const Plan& plan, const ValidatedParameters& parameters) {
  if (!plan.budgetMs) return parameters;
  TuningParameters changed = *parameters;
  changed.measure.budget = Milliseconds{*plan.budgetMs};
  const Result<ValidatedParameters> valid = validate(changed);
  return valid ? *valid : parameters;
}

Findings faultsOf(const Plan& plan) {
  Findings faults;
  if (plan.flights.empty()) faults.push_back(fault("--flight", "at least one", "none"));
  if (plan.budgetMs && plan.maxError) faults.push_back(fault("--max-error", "a budget or an error", "both"));
  const Range budget = findRow("measure.budget_ms")->hard;
  if (plan.budgetMs && !(*plan.budgetMs >= budget.low && *plan.budgetMs <= budget.high))
    faults.push_back(fault("--budget-ms", numberText(budget.low) + " to " + numberText(budget.high) + " ms",
                           numberText(*plan.budgetMs) + " ms"));
  const ErrorKindRow& error = rowOf(plan.error);
  if (plan.maxError && !(*plan.maxError > 0 && *plan.maxError <= error.greatest))
    faults.push_back(fault(
        "--max-error", "a " + std::string(error.words) + " above 0 and at most " + numberText(error.greatest),
        numberText(*plan.maxError)));
  if (plan.error == ErrorKind::pop && !isEnoughFor(0.95, plan.frames))
    faults.push_back(fault("--frames", "frames enough for a 95th percentile of pops, at least 20",
                           std::to_string(plan.frames)));
  std::set<std::string> names;
  std::map<std::string, std::string> seen;  ///< names by what is flown
  for (const auto* list : {&plan.flights, &plan.heldOut})
    for (const auto& flight : *list) {
      const char* const option = list == &plan.flights ? "--flight" : "--hold-out";
      const char* const once = "each flight once, so that what is held out was not seen";
      const auto [same, isNew] = seen.emplace(harness::planText({{"", flight.flight}}), flight.name);
      if (!names.insert(flight.name).second)
        faults.push_back(fault(option, once, flight.name + " twice"));
      else if (!isNew)
        faults.push_back(fault(option, once, flight.name + ", which flies as " + same->second + " does"));
      if (plan.terrain && harness::sampledRows(flight.flight, *plan.terrain, 1).empty())
        faults.push_back(
            {Severity::error, option, flight.name, "a flight over the terrain " + plan.terrainName,
             "none of its " + std::to_string(flight.flight.states.size()) + " rows lies over it"});
    }
  // A scene of OpenSceneGraph has an index without a form in it.
  const std::shared_ptr<const LoadIndex> index = scene::loadIndexOf(plan.terrain);
  if (!index || !(index->tiles || index->patches || index->trees))
    faults.push_back(fault("--terrain", "a database of Trimtab, whose levels can be counted without drawing",
                           plan.terrainName));
  return faults;
}

class Run {
 public:
  Run(const Plan& plan, const RunFolder& folder, experiment::Stage& stage, const SearchSpace& space)
      : plan_(plan), folder_(folder), stage_(stage), space_(space) {}

  Result<Outcome> all() {
    if (Findings failed = makeModels(); !failed.empty()) return failed;
    if (Findings failed = drawAll(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("then the searches come");
    if (Findings failed = searchAll(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("then presets are tried out");
    if (Findings failed = tryOut(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("then presets are measured");
    addOthers();
    addFound();
    if (Findings failed = measureAll(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("the last part, or a run without one, joins them");
    findIdle();
    markFront(plan_, outcome_.presets);
    if (Findings failed = writePresets(); !failed.empty()) return failed;
    outcome_.answer = answerOf(plan_, outcome_.presets);
    outcome_.machine = stage_.machine();
    return std::move(outcome_);
  }

 private:
  bool isMine(std::size_t number) const {
    return !plan_.part || number % plan_.part->count == plan_.part->index;
  }
  bool goOn(double fraction, const std::string& what) const {
    if (!plan_.progress) return true;
    const Clock::time_point asked = Clock::now();
    const bool on = plan_.progress(fraction, what);
    paused_ += Clock::now() - asked;
    return on;
  }
  /// Returns the seconds that this run has worked: it may be paused in its progress.
  double workedS() const { return std::chrono::duration<double>(Clock::now() - begin_ - paused_).count(); }
  Findings stopped() const {
    return {{Severity::error, folder_.path().string(), "", "to run to its end",
             "it was cancelled; the same command goes on from what is there"}};
  }
  Result<Outcome> partDone(const std::string& next) {
    outcome_.notes.push_back(missing_ + "; " + next + '.');
    return std::move(outcome_);
  }
  std::size_t flights() const { return plan_.flights.size() + plan_.heldOut.size(); }
  const harness::Plan::NamedFlight& flight(std::size_t i) const {
    return i < plan_.flights.size() ? plan_.flights[i] : plan_.heldOut[i - plan_.flights.size()];
  }
  std::span<const FlightModel> seen() const { return std::span(models_).first(plan_.flights.size()); }

  Findings makeModels();
  Findings drawAll();
  Findings emptyFrame(const FlightModel& model) const;
  Findings searchAll();
  void addOthers();
  void findIdle();
  void add(const std::string& name, Role role, const ValidatedParameters& parameters);
  void addFound();
  harness::Plan drawing() const;
  Result<harness::Results> draw(harness::Plan plan, const std::string& folder, double from, double to) const;
  Findings tryOut();
  Findings measureAll();
  Findings writePresets() const;

  const Plan& plan_;
  const RunFolder& folder_;
  experiment::Stage& stage_;
  const SearchSpace& space_;
  std::vector<FlightModel> models_;  ///< by flight, those that the search sees first
  std::string missing_;              ///< what other parts have not done yet; empty: nothing
  std::vector<Candidate> front_;     ///< by the estimates, and once presets were tried out, of those
  Outcome outcome_;
  const Clock::time_point begin_ = Clock::now();
  mutable Clock::duration paused_{0};
};

Findings Run::makeModels() {
  const double begin = workedS();
  for (std::size_t i = 0; i < flights(); ++i) {
    if (!goOn(0, "counting the triangles of " + flight(i).name)) return stopped();
    models_.emplace_back(FlightModel::Scene{plan_.terrain, plan_.widthPx, plan_.heightPx}, flight(i).flight,
                         plan_.start, plan_.drawnRows, plan_.error);
    if (models_.back().toDraw().empty())
      return {fault(flight(i).name.c_str(), "a flight over the terrain " + plan_.terrainName,
                    "none of its " + std::to_string(flight(i).flight.states.size()) + " rows lies over it")};
  }
  outcome_.buildS = workedS() - begin;
  const auto isTreeError = [](const Axis& axis) { return axis.name == "static_lod.error"; };
  if (plan_.start->terrain.form == TerrainForm::static_trees &&
      std::ranges::any_of(space_.axes(), isTreeError))
    outcome_.notes.push_back(
        "Estimates take the errors of static trees as the start's static_lod.error measures them: what "
        "another "
        "measure draws shows where presets are drawn.");
  return {};
}

Findings Run::drawAll() {
  for (std::size_t i = 0; i < flights(); ++i) {
    std::optional<DrawnSamples> samples = folder_.samples(i);
    if (!samples && !isMine(i)) {
      if (missing_.empty()) missing_ = folder_.samplesFile(i).string() + " is missing";
      continue;
    }
    if (!samples) {
      samples = drawSamples(stage_, models_[i].toDraw(), plan_.error, [&](double part) {
        return goOn(kSamplesPart * (static_cast<double>(i) + part) / static_cast<double>(flights()),
                    "drawing samples of " + flight(i).name);
      });
      if (!samples) return stopped();
      if (const auto written = folder_.write(i, *samples); !written) return written.findings();
    }
    models_[i].learn(*samples);
    if (i < plan_.flights.size())
      if (Findings failed = emptyFrame(models_[i]); !failed.empty()) return failed;
  }
  return {};
}

/// Refuses a budget that not even an image without ground stays within.
Findings Run::emptyFrame(const FlightModel& model) const {
  if (!plan_.budgetMs || *plan_.budgetMs > model.emptyMs()) return {};
  return {fault("--budget-ms",
                "more than an image without ground takes, about " + numberText(model.emptyMs(), 3) + " ms",
                numberText(*plan_.budgetMs) + " ms")};
}

Findings Run::searchAll() {
  const double begin = workedS();
  const Judge judge(plan_, space_, seen());
  for (std::size_t s = 0; s < plan_.searches; ++s) {
    std::optional<std::vector<Candidate>> front = folder_.search(s);
    if (!front && !isMine(s)) {
      if (missing_.empty()) missing_ = folder_.searchFile(s).string() + " is missing";
      continue;
    }
    if (!front) {
      Search search;
      search.axes = space_.size();
      search.seeds = {space_.placeOf(*plan_.start), space_.placeOf(TuningParameters{})};
      for (const std::string_view shipped : shippedPresets())
        if (const Result<Preset> preset = loadPreset(std::string(shipped)))
          search.seeds.push_back(space_.placeOf(preset->parameters));
      search.evaluate = [&judge](std::span<const double> place) { return judge(place); };
      search.evaluations = plan_.evaluations;
      search.seed = plan_.seed + s;
      bool cancelled = false;
      search.progress = [&](double part) {
        const double done = (static_cast<double>(s) + part) / static_cast<double>(plan_.searches);
        cancelled = !goOn(kSamplesPart + (kSearchPart - kSamplesPart) * done,
                          "search " + std::to_string(s + 1) + " of " + std::to_string(plan_.searches));
        return !cancelled;
      };
      front = frontOf(search);
      if (cancelled) return stopped();
      outcome_.evaluations += plan_.evaluations;
      if (const auto written = folder_.write(s, *front); !written) return written.findings();
    }
    front_ = joined(std::move(front_), *front);
  }
  outcome_.searchS = workedS() - begin;
  if (missing_.empty() && front_.empty())
    return {fault("--free", "parameters of which some values break no rule", "none that was tried")};
  return {};
}

void Run::add(const std::string& name, Role role, const ValidatedParameters& parameters) {
  Tuned preset;
  preset.name = name;
  preset.role = role;
  preset.parameters = withBudgetOf(plan_, parameters);
  for (const FlightModel& model : models_) preset.estimates.push_back(model.estimate(preset.parameters));
  for (const Difference& d : differences(*withBudgetOf(plan_, plan_.start), *preset.parameters))
    preset.moved.push_back(d.key + ": " + d.left + " to " + d.right);
  outcome_.presets.push_back(std::move(preset));
}

void Run::addFound() {
  std::size_t number = 0;
  for (const Candidate& candidate : chosen(plan_, front_, plan_.points, kMeasuredFrom, kMeasuredTo))
    if (const Result<ValidatedParameters> valid = validate(space_.at(candidate.place)))
      add("tuned-" + std::to_string(++number), Role::found, *valid);
}

/// Adds what the found presets are held against: the start, the default, and what a person would try.
void Run::addOthers() {
  const Judge judge(plan_, space_, seen());
  add(plan_.startName + " (start)", Role::start, plan_.start);
  if (!differences(*plan_.start, *withBudgetOf(plan_, defaultParameters())).empty())
    add("default", Role::standard, defaultParameters());
  if (!plan_.budgetMs && !plan_.maxError) return;
  for (const auto& [name, role, candidate] :
       {std::tuple{"one-parameter", Role::single, bestSingle(judge, space_.placeOf(*plan_.start))},
        std::tuple{"best-of-200-random", Role::random, bestRandom(judge, space_.size(), plan_.seed)}})
    if (const auto valid = validate(space_.at(candidate.place))) add(name, role, *valid);
}

void Run::findIdle() {
  const std::vector<double> start = space_.placeOf(*plan_.start);
  std::vector<bool> moves(space_.size(), false);
  for (const Tuned& preset : outcome_.presets) {
    if (preset.role != Role::found) continue;
    const std::vector<double> place = space_.placeOf(*preset.parameters);
    for (std::size_t i = 0; i < place.size(); ++i) moves[i] = moves[i] || place[i] != start[i];
  }
  for (std::size_t i = 0; i < moves.size(); ++i)
    if (!moves[i]) outcome_.idle.push_back(space_.axes()[i].name);
}

/// Returns how presets are drawn: as they are flown, in turns.
harness::Plan Run::drawing() const {
  harness::Plan plan;
  plan.terrain = plan_.terrain;
  plan.terrainName = plan_.terrainName;
  plan.cases = {CullingCase::proposed};
  plan.widthPx = plan_.widthPx;
  plan.heightPx = plan_.heightPx;
  plan.worst = 1;
  plan.skips = false;
  plan.version = plan_.version;
  plan.part = plan_.part;
  return plan;
}

Result<harness::Results> Run::draw(harness::Plan plan, const std::string& folder, double from,
                                   double to) const {
  plan.progress = [this, from, to](double part, const std::string& what) {
    return goOn(from + (to - from) * part, what);
  };
  return harness::run(plan, folder_.path() / folder);
}

/// Draws presets around the limit in the rows that tell them apart, at the full size, on which times depend.
/// What is left of the front are these, each corrected by what its own estimate missed.
Findings Run::tryOut() {
  const Judge judge(plan_, space_, seen());
  const std::vector<double> start = space_.placeOf(*plan_.start);
  harness::Plan plan = drawing();
  plan.flights = plan_.flights;
  plan.repeats = kTriedRepeats;
  std::vector<Candidate> tried;
  std::vector<std::vector<std::vector<RowEstimate>>> estimates(seen().size());  // by flight and preset
  for (const Candidate& candidate :
       chosen(plan_, front_, kTriedForOne * plan_.points, kTriedFrom, kTriedTo)) {
    Candidate simple = simplified(judge, start, candidate);
    const Result<ValidatedParameters> valid = validate(space_.at(simple.place));
    const auto isKnown = [&](const Candidate& other) { return other.place == simple.place; };
    if (!valid || std::ranges::any_of(tried, isKnown)) continue;
    plan.presets.push_back({"tried-" + std::to_string(tried.size() + 1), *valid});
    tried.push_back(std::move(simple));
    for (std::size_t i = 0; i < seen().size(); ++i) seen()[i].estimate(*valid, &estimates[i].emplace_back());
  }
  if (tried.empty()) return {};
  for (const auto& ofFlight : estimates) plan.rows.push_back(rowsApart(ofFlight, kTriedFrames));
  const auto results = draw(plan, "tried", kSearchPart, kTriedPart);
  if (!results) return results.findings();
  if (results->units.empty()) {
    missing_ = results->notes.front();
    return {};
  }
  std::vector<Candidate> corrected;
  std::vector<double> times, errors;
  for (std::size_t p = 0; p < tried.size(); ++p) {
    std::vector<Missed> missed(seen().size());
    for (const harness::Unit& unit : results->units)
      for (std::size_t i = 0; i < seen().size(); ++i)
        if (unit.name.preset == plan.presets[p].name && unit.name.flight == plan.flights[i].name)
          missed[i] = missedBy(plan_.error, estimates[i][p], unit.frames);
    corrected.push_back({tried[p].place, judge.of(plan.presets[p].parameters, missed)});
    for (const Missed& m : missed) times.push_back(m.time), errors.push_back(m.error);
  }
  front_ = joined(std::move(corrected), {});
  outcome_.notes.push_back("Where they were tried out, " + std::to_string(tried.size()) + " presets took " +
                           rangeText(times) + " times what was estimated, at " + rangeText(errors) +
                           " times the error.");
  return {};
}

Findings Run::measureAll() {
  harness::Plan plan = drawing();
  for (std::size_t i = 0; i < flights(); ++i) plan.flights.push_back(flight(i));
  for (const Tuned& preset : outcome_.presets) plan.presets.push_back({preset.name, preset.parameters});
  plan.frames = plan_.frames;
  plan.repeats = plan_.repeats;
  const auto results = draw(std::move(plan), "measured", kTriedPart, 1);
  if (!results) return results.findings();
  if (results->units.empty()) missing_ = results->notes.front();
  outcome_.othersShare = results->othersShare;
  for (Tuned& preset : outcome_.presets)
    for (std::size_t i = 0; i < flights(); ++i)
      for (const harness::Unit& unit : results->units)
        if (unit.name.preset == preset.name && unit.name.flight == flight(i).name)
          preset.measured.push_back(harness::answerRow(unit, plan_.budgetMs.value_or(kNan)));
  outcome_.notes.push_back("Counting the flights took " + numberText(outcome_.buildS, 2) + " s and " +
                           std::to_string(outcome_.evaluations) + " estimates " +
                           numberText(outcome_.searchS, 2) + " s.");
  return {};
}

Findings Run::writePresets() const {
  std::error_code error;
  const std::filesystem::path folder = folder_.path() / "presets";
  std::filesystem::create_directories(folder, error);
  for (const Tuned& preset : outcome_.presets) {
    if (preset.role != Role::found) continue;
    Preset file;
    file.name = preset.name;
    file.base = "default";
    file.description = "Found by a search from " + plan_.startName + " over " + plan_.terrainName +
                       ", seed " + std::to_string(plan_.seed) + ".";
    file.parameters = *preset.parameters;
    const Result<std::string> text = presetText(file);
    if (!text) return text.findings();
    if (const auto written = writeAtomically(folder / (preset.name + ".json"), *text); !written)
      return written.findings();
  }
  return {};
}

}  // namespace

Result<Outcome> run(const Plan& given, const std::filesystem::path& folder) {
  Plan plan = given;
  if (Findings faults = faultsOf(plan); !faults.empty()) return faults;
  plan.start = withBudgetOf(plan, plan.start);
  const Result<SearchSpace> space = SearchSpace::make(*plan.start, plan.free);
  if (!space) return space.findings();
  experiment::Setup setup;
  setup.terrain = plan.terrain;
  setup.widthPx = plan.widthPx;
  setup.heightPx = plan.heightPx;
  const auto stage = experiment::Stage::open(setup);
  if (!stage) return stage.findings();
  const Result<RunFolder> opened = RunFolder::open(folder, plan, (*stage)->machine());
  if (!opened) return opened.findings();
  Result<Outcome> outcome = Run(plan, *opened, **stage, *space).all();
  // A part has no answer unless it was the last.
  if (!outcome || outcome->answer.empty()) return outcome;
  if (const auto written = experiment::writeReport(folder, toReport(plan, *outcome)); !written)
    return written.findings();
  return outcome;
}

}  // namespace trimtab::tune
