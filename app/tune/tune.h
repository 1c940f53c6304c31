#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/experiment/report.h"
#include "app/harness/answer.h"
#include "app/harness/run.h"
#include "flight_model.h"
#include "trimtab/preset/table.h"

/// Finds presets: the front of run time against error over some flights, drawn as it is flown, and what it is
/// worth on flights that the search has not seen.
namespace trimtab::tune {

/// Which time of a flight's images the search makes small.
enum class TimeMeasure { median, p95, p99 };

struct Plan {
  std::shared_ptr<const terrain::Database> terrain;
  std::string terrainName;
  std::vector<harness::Plan::NamedFlight> flights;  ///< that the search sees
  std::vector<harness::Plan::NamedFlight> heldOut;  ///< that it does not see; may be empty
  std::string startName = "default";
  ValidatedParameters start = defaultParameters();
  std::vector<std::string> free;  ///< as SearchSpace::make() reads them
  /// At most one of the two is set: the longest time, milliseconds, or the greatest error, in its own unit.
  std::optional<double> budgetMs, maxError;
  TimeMeasure time = TimeMeasure::p95;
  ErrorKind error = ErrorKind::flip;
  int widthPx = 1280, heightPx = 720;
  std::size_t drawnRows = 12;       ///< rows of a flight that estimates are made from
  std::size_t evaluations = 20000;  ///< of each search
  std::size_t searches = 1;         ///< with seeds of their own
  std::uint64_t seed = 1;
  std::size_t points = 4;                   ///< found presets that are drawn
  std::size_t frames = 24, repeats = 5;     ///< as harness::Plan
  std::string version;                      ///< of the program
  std::optional<harness::Plan::Part> part;  ///< unset: everything that is missing is done, and joined
  /// Called often; returning false cancels the run. What is finished stays in the folder.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// Where a preset comes from.
enum class Role { start, standard, single, random, found };

/// A preset with what it was estimated and measured to be worth.
struct Tuned {
  std::string name;
  Role role = Role::found;
  ValidatedParameters parameters = defaultParameters();
  /// One entry a flight: first the flights that the search saw, then those held out.
  std::vector<Estimate> estimates;
  std::vector<harness::AnswerRow> measured;
  /// What the preset moved: keys with the values of start and preset.
  std::vector<std::string> moved;
  bool onFront = false;  ///< of what was measured on the flights that the search saw
};

struct Outcome {
  std::vector<Tuned> presets;
  std::string answer;              ///< whole sentences for a person
  std::vector<std::string> idle;   ///< axes that no found preset needed to move
  std::vector<std::string> notes;  ///< conditions
  std::size_t evaluations = 0;
  double buildS = 0, searchS = 0;  ///< seconds for counting the flights and for searching; 0 if read
  std::string machine;
  double othersShare = std::numeric_limits<double>::quiet_NaN();  ///< as harness::Results
};

/// Runs a plan. `folder` keeps every finished part: drawn samples, the front of each search, each measured
/// frame. A run that was stopped goes on where it was and comes to the same presets, bit for bit, because
/// searches depend on the samples, the plan and the seed alone. The folder gets the found presets
/// (presets/NAME.json) and a page (tune.html, with JSON and CSV). It fails before any work if nothing may
/// move, if no flight lies over the terrain, or if the folder holds another plan, and says what to change.
///
/// With Plan::part it does that part's share of the next step that is not complete (drawing samples,
/// searching, trying out, measuring). While other parts' shares are missing, the outcome has no answer, and a
/// note says what is missing.
Result<Outcome> run(const Plan& plan, const std::filesystem::path& folder);

/// Returns the outcome as a table with the front as a plot, for whoever shows experiments.
experiment::Report toReport(const Plan& plan, const Outcome& outcome);

}  // namespace trimtab::tune
