#include <algorithm>
#include <cmath>
#include <cstdio>

#include "trimtab/experiment/experiment.h"
#include "trimtab/experiment/published.h"
#include "trimtab/terrain/static_lod.h"

namespace trimtab::experiment {
namespace {

constexpr double kPublishedTriangles = 30987;
constexpr std::uint32_t kPublishedN = 2000;

/// Triangles of the nodes of one tile, level by level; a leaf above the deepest level counts in all below.
struct TileCounts {
  double source = 0, faces = 0, lockedMinima = 0;
  std::vector<double> byLevel;
};

TileCounts countTile(const StaticLodIndex& index, std::uint32_t tile) {
  TileCounts counts;
  std::size_t levels = 0;
  for (const StaticLodIndex::Node& node : index.nodes)
    if (node.tile == tile) levels = std::max<std::size_t>(levels, node.depth + 1u);
  counts.byLevel.assign(levels, 0);
  for (const StaticLodIndex::Node& node : index.nodes) {
    if (node.tile != tile) continue;
    const bool leaf = node.children[0] == StaticLodIndex::kNone;
    counts.faces += node.triangles;
    counts.lockedMinima += node.lockedMinimum;
    if (leaf) counts.source += node.triangles;
    for (std::size_t level = node.depth; level < (leaf ? levels : node.depth + 1u); ++level)
      counts.byLevel[level] += node.triangles;
  }
  return counts;
}

/// Halving until a leaf holds at most n.
double permittedLevels(double triangles, double n) {
  return 1 + std::ceil(std::log2(triangles / n));
}

}  // namespace

Result<Report> runStaticLod(const Setup& setup) {
  const auto trees = setup.terrain->staticLod();
  if (!trees || trees->tiles.empty())
    return Finding{Severity::error,
                   setup.terrainName,
                   {},
                   "a database baked from scenery (.btg, .stg)",
                   "a terrain without static levels of detail"};
  std::uint32_t nearest = 0;
  std::vector<TileCounts> counts;
  for (std::uint32_t tile = 0; tile < trees->tiles.size(); ++tile) {
    counts.push_back(countTile(trees->index, tile));
    if (std::abs(counts[tile].source - kPublishedTriangles) <
        std::abs(counts[nearest].source - kPublishedTriangles))
      nearest = tile;
  }
  const TileCounts& tile = counts[nearest];
  const double n = trees->trianglesPerNode;

  Report report{"static-lod",
                "E: example tile",
                "counts only: they are the same on every machine",
                publishedStaticLod(),
                {},
                {},
                {}};
  report.measured.columns = {"quantity", "value", "permitted_by_the_rule"};
  const double levels = permittedLevels(tile.source, n);
  report.measured.rows = {
      {"triangles_original", tile.source, Cell()},       {"n", n, Cell()},
      {"levels", double(tile.byLevel.size()), levels},   {"faces_all_levels", tile.faces, 2 * tile.source},
      {"faces_ratio", tile.faces / tile.source, Cell()}, {"locked_minima", tile.lockedMinima, Cell()},
  };
  for (std::size_t level = 0; level < tile.byLevel.size(); ++level)
    report.measured.rows.push_back({"faces_level_" + std::to_string(level), tile.byLevel[level], Cell()});

  char text[320];
  std::snprintf(text, sizeof text,
                "%s, tile %s: of %zu tiles the one whose triangles are nearest to the published %.0f.",
                setup.terrainName.c_str(), trees->tiles[nearest].name.c_str(), trees->tiles.size(),
                kPublishedTriangles);
  report.notes = {text};
  std::snprintf(
      text, sizeof text,
      "The published example is out of its own rule's reach: leaves of at most %u of %.0f triangles are at "
      "least 16, which makes 5 levels and not 4, and 2.0 to 2.9 times the triangles over all levels, not "
      "%.2f.",
      kPublishedN, kPublishedTriangles, 126520 / kPublishedTriangles);
  report.notes.push_back(text);
  if (trees->trianglesPerNode != kPublishedN) {
    std::snprintf(text, sizeof text,
                  "This database was baked with n = %u; bake with --leaf-triangles %u to compare.",
                  trees->trianglesPerNode, kPublishedN);
    report.notes.push_back(text);
  }
  Plot plot{"static-lod-faces", "Faces by level, root first", "level", "faces", {}, {{"measured", {}, {}}}};
  for (std::size_t level = 0; level < tile.byLevel.size(); ++level) {
    plot.categories.push_back(std::to_string(level));
    plot.series[0].y.push_back(tile.byLevel[level]);
  }
  report.plots = {plot};
  return report;
}

}  // namespace trimtab::experiment
