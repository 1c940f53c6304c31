#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "results.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

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
  std::size_t frames = 60;  ///< of each flight, evenly spread over its rows above the terrain
  /// The rows to measure instead, ascending, of each flight; empty: those of `frames`.
  std::vector<std::vector<std::size_t>> rows;
  std::size_t repeats = 5;  ///< timed draws of a frame
  /// Presets whose decisions depend on their own images draw every row of a flight, instead of those rows
  /// that may have an effect on a sampled frame.
  bool whole = false;
  std::size_t worst = 3;  ///< most worst frames kept of each unit
  bool skips = true;      ///< whether to measure what skipped work saved
  std::string version;    ///< of the program
  /// One of several processes or machines that share the folder: of the sampled frames it measures those
  /// whose number leaves `index` when divided by `count`; with an index of `count` it measures none. While
  /// frames of other parts are missing, run() writes no results and returns some without units, whose notes
  /// say what is missing; the last part joins them, or a run without a part.
  struct Part {
    std::size_t index = 0, count = 1;
  };
  std::optional<Part> part;
  /// Called often; returning false cancels the run. Finished parts stay in the folder.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// Returns the name of a case in files and on the command line.
std::string_view caseName(CullingCase method);

/// Measures every preset as it is flown: one session decides all rows of a flight, and is given the triangles
/// and times of its own images if its policy, its head motion or its budget depends on them (flyFrames).
///
/// Measures everything that `folder` does not hold yet and writes results.json, frames.csv, report.html and
/// the images of the worst frames there. Each sampled frame of a flight, in all presets and cases, is written
/// atomically below parts/ once it is complete, so that a stopped run continues where it was. Fails if the
/// folder belongs to another plan, saying what differs. Makes a GL context of its own, current on the calling
/// thread.
Result<Results> run(const Plan& plan, const std::filesystem::path& folder);

}  // namespace trimtab::harness
