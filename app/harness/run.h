#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/harness/results.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/database.h"

namespace trimtab::harness {

struct Plan {
  std::shared_ptr<const terrain::Database> terrain;
  std::string terrainName;
  struct NamedFlight {
    std::string name;
    Flight flight;
  };
  std::vector<NamedFlight> flights;
  struct NamedPreset {
    std::string name;
    ValidatedParameters parameters;
  };
  std::vector<NamedPreset> presets;
  std::vector<CullingCase> cases{CullingCase::none, CullingCase::view_frustum, CullingCase::proposed};
  int widthPx = 1280, heightPx = 720;
  std::size_t frames = 60;  ///< of each flight, evenly spread
  std::size_t repeats = 5;  ///< timed draws of a frame
  std::size_t worst = 3;    ///< pictures kept of each unit
  /// Told often; false cancels. What is done by then stays in the folder.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// Measures everything that `folder` does not hold yet and leaves results.json, frames.csv, report.html and
/// the worst frames' pictures there. Each unit is written atomically once it is whole: a run that was stopped
/// goes on where it was; a folder of another plan is refused. Makes a GL context of its own, current on the
/// calling thread.
Result<Results> run(const Plan& plan, const std::filesystem::path& folder);

/// A page that needs nothing beside it: summary table, stages, counts, errors, frame time against error, the
/// worst frames as pictures. `folder` is where the pictures' files are.
Result<std::string> htmlReport(const Results& results, const std::filesystem::path& folder);

}  // namespace trimtab::harness
