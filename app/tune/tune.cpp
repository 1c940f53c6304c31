#include "tune.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include "candidates.h"
#include "run_folder.h"
#include "search_space.h"
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
/// So much is drawn of presets to try them out.
constexpr std::size_t kTriedFrames = 8, kTriedRepeats = 2;
/// Estimates that miss by less than this part are right enough for the first presets that are drawn.
constexpr double kRightEnough = 0.03;

Finding fault(const char* what, std::string expected, std::string found) {
  return {Severity::error, what, "", std::move(expected), std::move(found)};
}

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
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
  std::set<std::string> names;
  for (const auto* list : {&plan.flights, &plan.heldOut})
    for (const auto& flight : *list)
      if (!names.insert(flight.name).second)
        faults.push_back(fault("--flight", "each flight once, so that what is held out was not seen",
                               flight.name + " twice"));
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
    if (Findings failed = emptyFrame(); !failed.empty()) return failed;
    if (Findings failed = searchAll(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("then presets are tried out");
    addOthers();
    addFound(chosen(plan_, front_, plan_.points, 1));
    if (Findings failed = tryOut(); !failed.empty()) return failed;
    if (!missing_.empty()) return partDone("then presets are measured");
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
    return !plan_.progress || plan_.progress(fraction, what);
  }
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
  Findings emptyFrame() const;
  Findings searchAll();
  void addOthers();
  void findIdle();
  void add(const std::string& name, Role role, const ValidatedParameters& parameters);
  void addFound(std::vector<Candidate> candidates);
  Result<harness::Results> draw(std::span<const Tuned* const> presets, std::size_t frames,
                                std::size_t repeats, const std::string& folder, double from, double to) const;
  Findings tryOut();
  Findings measureAll();
  Findings writePresets() const;

  const Plan& plan_;
  const RunFolder& folder_;
  experiment::Stage& stage_;
  const SearchSpace& space_;
  std::vector<FlightModel> models_;  ///< by flight, those that the search sees first
  std::string missing_;              ///< what other parts have not done yet; empty: nothing
  std::vector<Candidate> front_;
  Outcome outcome_;
};

Findings Run::makeModels() {
  const auto begin = Clock::now();
  for (std::size_t i = 0; i < flights(); ++i) {
    if (!goOn(0, "counting the triangles of " + flight(i).name)) return stopped();
    models_.emplace_back(FlightModel::Scene{plan_.terrain, plan_.widthPx, plan_.heightPx}, flight(i).flight,
                         plan_.start, plan_.drawnRows);
    if (models_.back().toDraw().empty())
      return {fault(flight(i).name.c_str(), "a flight over the terrain " + plan_.terrainName,
                    "none of its " + std::to_string(flight(i).flight.states.size()) + " rows lies over it")};
  }
  outcome_.buildS = secondsSince(begin);
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
      samples = drawSamples(stage_, models_[i].toDraw(), [&](double part) {
        return goOn(kSamplesPart * (static_cast<double>(i) + part) / static_cast<double>(flights()),
                    "drawing samples of " + flight(i).name);
      });
      if (!samples) return stopped();
      if (const auto written = folder_.write(i, *samples); !written) return written.findings();
    }
    models_[i].learn(*samples);
  }
  return {};
}

/// Refuses a budget that not even an image without ground stays within.
Findings Run::emptyFrame() const {
  double emptyMs = 0;
  for (const FlightModel& model : seen()) emptyMs = std::max(emptyMs, model.emptyMs());
  if (!plan_.budgetMs || *plan_.budgetMs > emptyMs) return {};
  return {fault("--budget-ms",
                "more than an image without ground takes, about " + numberText(emptyMs, 3) + " ms",
                numberText(*plan_.budgetMs) + " ms")};
}

Findings Run::searchAll() {
  const auto begin = Clock::now();
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
  outcome_.searchS = secondsSince(begin);
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

void Run::addFound(std::vector<Candidate> candidates) {
  const Judge judge(plan_, space_, seen());
  const std::vector<double> start = space_.placeOf(*plan_.start);
  std::size_t number = 0;
  for (const Tuned& preset : outcome_.presets) number += preset.role == Role::found;
  for (Candidate& candidate : candidates) {
    candidate = simplified(judge, start, std::move(candidate));
    const Result<ValidatedParameters> valid = validate(space_.at(candidate.place));
    if (!valid) continue;
    const bool known =
        std::any_of(outcome_.presets.begin(), outcome_.presets.end(), [&](const Tuned& preset) {
          return differences(*preset.parameters, *withBudgetOf(plan_, *valid)).empty();
        });
    if (!known) add("tuned-" + std::to_string(++number), Role::found, *valid);
  }
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

/// Draws presets as they are flown, in turns.
Result<harness::Results> Run::draw(std::span<const Tuned* const> presets, std::size_t frames,
                                   std::size_t repeats, const std::string& folder, double from,
                                   double to) const {
  harness::Plan plan;
  plan.terrain = plan_.terrain;
  plan.terrainName = plan_.terrainName;
  for (std::size_t i = 0; i < flights(); ++i) plan.flights.push_back(flight(i));
  for (const Tuned* preset : presets) plan.presets.push_back({preset->name, preset->parameters});
  plan.cases = {CullingCase::proposed};
  plan.widthPx = plan_.widthPx;
  plan.heightPx = plan_.heightPx;
  plan.frames = frames;
  plan.repeats = repeats;
  plan.worst = 1;
  plan.skips = false;
  plan.version = plan_.version;
  plan.part = plan_.part;
  plan.progress = [this, from, to](double part, const std::string& what) {
    return goOn(from + (to - from) * part, what);
  };
  return harness::run(plan, folder_.path() / folder);
}

/// Draws a few frames of the presets that were found, and chooses others where the estimates missed: the
/// limit is moved by what they missed by.
Findings Run::tryOut() {
  if (!plan_.budgetMs && !plan_.maxError) return {};
  std::vector<const Tuned*> found;
  for (const Tuned& preset : outcome_.presets)
    if (preset.role == Role::found) found.push_back(&preset);
  if (found.empty()) return {};
  const auto results = draw(found, kTriedFrames, kTriedRepeats, "tried", kSearchPart, kTriedPart);
  if (!results) return results.findings();
  if (results->units.empty()) missing_ = results->notes.front();
  std::vector<double> ratios;
  for (const Tuned* preset : found)
    for (std::size_t i = 0; i < plan_.flights.size(); ++i)
      for (const harness::Unit& unit : results->units) {
        if (unit.name.preset != preset->name || unit.name.flight != flight(i).name) continue;
        const harness::AnswerRow row = harness::answerRow(unit, kNan);
        const Estimate& e = preset->estimates[i];
        ratios.push_back(plan_.maxError ? row.flip / e.flip : row.medianMs / e.medianMs);
      }
  std::erase_if(ratios, [](double ratio) { return !std::isfinite(ratio) || !(ratio > 0); });
  if (ratios.empty()) return {};
  std::sort(ratios.begin(), ratios.end());
  const double missed = ratios[ratios.size() / 2];
  outcome_.notes.push_back("Where it was tried out, a found preset was drawn at " + numberText(missed, 3) +
                           " times what was estimated (median).");
  if (std::abs(missed - 1) < kRightEnough) return {};
  std::erase_if(outcome_.presets, [](const Tuned& preset) { return preset.role == Role::found; });
  addFound(chosen(plan_, front_, plan_.points, 1 / missed));
  return {};
}

Findings Run::measureAll() {
  std::vector<const Tuned*> all;
  for (const Tuned& preset : outcome_.presets) all.push_back(&preset);
  const auto results = draw(all, plan_.frames, plan_.repeats, "measured", kTriedPart, 1);
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
