#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "results.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::harness {

struct Plan {
  std::shared_ptr<const terrain::Database> terrain;
  std::string terrainName;
  struct NamedFlight {
    std::string name;
    Flight flight;
    /// Where the flight is a trace: replayed with the cost and the heights that it recorded. Else empty, and
    /// decisions are given no cost: what they see must not depend on this machine.
    std::vector<TraceRow> trace = {};
  };
  std::vector<NamedFlight> flights;
  struct NamedPreset {
    std::string name;
    ValidatedParameters parameters;
  };
  std::vector<NamedPreset> presets;
  std::vector<CullingCase> cases{CullingCase::none, CullingCase::view_frustum, CullingCase::proposed};
  int widthPx = 1280, heightPx = 720;
  std::size_t frames = 60;  ///< of each flight, evenly spread over its rows that lie over the terrain
  std::size_t repeats = 5;  ///< timed draws of a frame
  std::size_t worst = 3;    ///< most pictures kept of each unit
  bool skips = true;        ///< measure what skipped work saved
  std::string version;      ///< of the program
  /// Told often; false cancels. What is done by then stays in the folder.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// How a case is spelled in files and on the command line.
std::string_view caseName(CullingCase method);

/// Measures everything that `folder` does not hold yet and leaves results.json, frames.csv, report.html and
/// the worst frames' pictures there. Each sampled frame of a flight, in all presets and cases, is written
/// atomically once it is whole (below parts/): a run that was stopped goes on where it was; a folder of
/// another plan is refused with what differs. Makes a GL context of its own, current on the calling thread.
Result<Results> run(const Plan& plan, const std::filesystem::path& folder);

/// A page that needs nothing beside it: summary table, stages, counts, errors, frame time against error, the
/// worst frames as pictures. `folder` is where the pictures' files are.
Result<std::string> htmlReport(const Results& results, const std::filesystem::path& folder);

}  // namespace trimtab::harness
