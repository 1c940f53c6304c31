#include <cstdio>

#include "trimtab/experiment/experiment.h"
#include "trimtab/experiment/published.h"
#include "trimtab/terrain/static_lod.h"

namespace trimtab::experiment {
namespace {

constexpr std::uint64_t kPublishedTriangles = 30987;
constexpr std::uint32_t kPublishedN = 2000;

}  // namespace

Result<Report> runStaticLod(const Setup& setup) {
  const auto trees = setup.terrain->staticLod();
  if (!trees || trees->tiles.empty())
    return Finding{Severity::error,
                   setup.terrainName,
                   {},
                   "a database baked from scenery (.btg, .stg)",
                   "a terrain without static levels of detail"};
  const terrain::StaticLodReport tile =
      terrain::reportStaticLod(*trees, terrain::tileNearest(*trees, kPublishedTriangles));
  const auto number = [](auto count) { return static_cast<double>(count); };

  Report report{"static-lod",
                "E: example tile",
                "counts only: they are the same on every machine",
                publishedStaticLod(),
                {},
                {},
                {}};
  report.measured.columns = {"quantity",       "value",       "permitted_least",
                             "permitted_most", "rms_error_m", "max_error_m"};
  const auto row = [&](std::string quantity, double value, Cell least = {}, Cell most = {}, Cell rms = {},
                       Cell max = {}) {
    report.measured.rows.push_back({std::move(quantity), value, least, most, rms, max});
  };
  row("triangles_original", number(tile.triangles));
  row("n", number(tile.trianglesPerNode));
  row("levels", number(tile.levels), number(tile.limits.levels));
  row("faces_all_levels", number(tile.faces), number(tile.limits.leastFaces), number(tile.limits.mostFaces));
  row("faces_ratio", number(tile.faces) / number(tile.triangles));
  row("locked_minima", number(tile.lockedMinima));
  for (std::size_t level = 0; level < tile.facesOfLevel.size(); ++level)
    row("faces_level_" + std::to_string(level), number(tile.facesOfLevel[level]), {}, {},
        tile.rmsErrorM[level], tile.maxErrorM[level]);

  char text[320];
  std::snprintf(text, sizeof text,
                "%s, tile %s: of %zu tiles the one whose triangles are nearest to the published %.0f.",
                setup.terrainName.c_str(), tile.tile.c_str(), trees->tiles.size(),
                number(kPublishedTriangles));
  report.notes = {text};
  std::snprintf(
      text, sizeof text,
      "The published example is out of its own rule's reach: leaves of at most %u of %.0f triangles are at "
      "least 16, which makes 5 levels and not 4, and 2.0 to 2.9 times the triangles over all levels, not "
      "%.2f.",
      kPublishedN, number(kPublishedTriangles), 126520 / number(kPublishedTriangles));
  report.notes.push_back(text);
  if (trees->trianglesPerNode != kPublishedN) {
    std::snprintf(text, sizeof text,
                  "This database was baked with n = %u; bake with --leaf-triangles %u to compare.",
                  trees->trianglesPerNode, kPublishedN);
    report.notes.push_back(text);
  }
  Plot plot{"static-lod-faces", "Faces by level, root first", "level", "faces", {}, {{"measured", {}, {}}}};
  for (std::size_t level = 0; level < tile.facesOfLevel.size(); ++level) {
    plot.categories.push_back(std::to_string(level));
    plot.series[0].y.push_back(number(tile.facesOfLevel[level]));
  }
  report.plots = {plot};
  return report;
}

}  // namespace trimtab::experiment
