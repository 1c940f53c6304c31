#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "damage.h"
#include "feed.h"
#include "file_watch.h"
#include "health.h"
#include "preset_watch.h"
#include "surface.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/measure/lever_tally.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/measure/trace_file.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::ig {

using TerrainWatch = Watch<std::shared_ptr<const terrain::Database>>;

/// Holds everything that a run needs, opened and checked.
struct Run {
  const Options& options;
  const Wake& wake;
  Session& session;
  scene::Renderer& renderer;
  Surface& surface;
  Feed& feed;
  Damage& damage;
  TraceFile* trace = nullptr;
  Health* health = nullptr;
  PresetWatch* watch = nullptr;          ///< made before the preset is loaded, so that no change is missed
  TerrainWatch* terrainWatch = nullptr;  ///< made before the terrain is opened
};

struct Summary {
  std::uint64_t frames = 0, packets = 0, decisionChanges = 0, jumps = 0, presetReloads = 0,
                presetsRefused = 0, terrainReloads = 0, terrainsRefused = 0;
  std::uint64_t damagedPlaces = 0;  ///< of the terrain, that were read for an image
  std::uint64_t groundDoubted = 0;  ///< packets whose height above ground contradicts the terrain
  std::uint64_t depthMapsDrawn = 0, horizonsBuilt = 0, overBudget = 0;
  LeverTally levers;
  std::array<std::uint64_t, kHoldReasons> held{};  ///< images, by what the arbiter of the budget did
  double firstFrameTime = 0;                       ///< link::now() when the first image was finished; 0: none
  double medianFrameMs = 0, p99FrameMs = 0;
  std::array<Distribution, kCostStages.size()> stages;  ///< milliseconds, in the order of kCostStages
  std::optional<FrameRequest> lastRequest;
  /// Percentiles of latency; NaN if nothing was measured.
  double decodedP50Ms = 0, decodedP99Ms = 0, shownP50Ms = 0, shownP99Ms = 0, everyP99Ms = 0;
};

/// Draws the centre of the terrain once without and once with the depth map of each band, so that shaders are
/// compiled and memory is allocated before the first packet arrives. These frames are not counted.
void warmUp(const Run& run, const terrain::Database& database);

/// Draws until the feed ends, enough frames are drawn, the window closes or a signal comes. Sleeps between
/// packets.
Summary drawFrames(const Run& run);

/// Draws the last image again and writes it: after a swap of buffers its pixels are undefined.
Result<Done> takeScreenshot(const Run& run, const Summary& summary, const std::filesystem::path& file);

/// Opens a baked database or a scene of OpenSceneGraph. The IG bakes nothing itself, so that it needs no
/// GDAL.
Result<std::shared_ptr<const terrain::Database>> openDatabase(const Options& options);

/// Returns the summary in one line for people.
std::string summaryLine(const Summary& summary, const Feed& feed);
/// Returns the summary as one JSON document.
std::string summaryJson(const Summary& summary, const Feed& feed, const Options& options,
                        const scene::GlReport& gl);

/// Prints findings on standard error, one per line, with their severity.
void report(const Findings& findings);

}  // namespace trimtab::ig
