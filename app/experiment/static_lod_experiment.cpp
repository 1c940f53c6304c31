#include <algorithm>
#include <cstdio>

#include "builders.h"
#include "experiment.h"
#include "published.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/fans.h"
#include "trimtab/terrain/static_lod/level.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::experiment {
namespace {

constexpr std::uint64_t kPublishedTriangles = 30987;
constexpr std::uint32_t kPublishedN = 2000;

/// The same tile with its lines kept, whichever way the database has it, and without.
struct Lines {
  std::vector<terrain::LineShare> published, kept;
  std::vector<std::uint64_t> keptFaces;  ///< by level
};
Result<Lines> linesOf(const terrain::StaticLodTerrain& trees, std::size_t tile, const Setup& setup) {
  const std::vector<terrain::SceneryMesh> source{terrain::sourceOf(trees, tile)};
  terrain::StaticLodOptions options;
  options.trianglesPerNode = trees.trianglesPerNode;
  options.progress = setup.progress;
  const auto published = terrain::buildStaticLod(source, trees.index.frame, options);
  if (!published) return published.findings();
  options.keepLines = true;
  const auto kept = terrain::buildStaticLod(source, trees.index.frame, options);
  if (!kept) return kept.findings();
  return Lines{terrain::lineShares(**published, 0), terrain::lineShares(**kept, 0),
               terrain::reportStaticLod(**kept, 0).facesOfLevel};
}

/// Says why the published example contradicts the document's own rule.
std::string readings() {
  const terrain::HalvedTree most =
      terrain::halvedTree(kPublishedTriangles, kPublishedN, terrain::LeafReading::atMost);
  const terrain::HalvedTree least =
      terrain::halvedTree(kPublishedTriangles, kPublishedN, terrain::LeafReading::atLeast);
  char text[480];
  std::snprintf(text, sizeof text,
                "The document's rule is at least n/2 and at most n triangles in a leaf, as built here. Its "
                "example contradicts it: with n = %u, %.0f triangles make %.0f leaves and %u levels, and the "
                "published %u levels are those of %.0f leaves, which hold more than n each. Its 126,520 "
                "faces (%.2f a triangle) count once what levels share; neither tree makes as many if every "
                "node above the leaves holds n.",
                kPublishedN, static_cast<double>(kPublishedTriangles), static_cast<double>(most.leaves),
                most.levels, least.levels, static_cast<double>(least.leaves),
                126520 / static_cast<double>(kPublishedTriangles));
  return text;
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
  const std::size_t nearest = terrain::tileNearest(*trees, kPublishedTriangles);
  const terrain::StaticLodReport tile = terrain::reportStaticLod(*trees, nearest);
  const auto number = [](auto count) { return static_cast<double>(count); };

  Report report{"static-lod",
                "E: example tile",
                "counts only: they are the same on every machine",
                publishedStaticLod(),
                {},
                {},
                {}};
  report.measured.columns = {
      "quantity",          "value",   "permitted_least", "permitted_most", "rms_error_m",
      "max_error_m",       "bytes",   "lines_share",     "shores_share",   "triangles_per_strip",
      "triangles_per_fan", "acmr_16", "acmr_32"};
  const auto row = [&](std::string quantity, double value, Cell least = {}, Cell most = {}, Cell rms = {},
                       Cell max = {}, Cell bytes = {}, Cell lines = {}, Cell shores = {}) {
    report.measured.rows.push_back({std::move(quantity), value, least, most, rms, max, bytes, lines, shores});
    report.measured.rows.back().resize(report.measured.columns.size());
  };
  row("triangles_original", number(tile.triangles));
  row("n", number(tile.trianglesPerNode));
  row("levels", number(tile.levels), number(tile.limits.levels));
  row("faces_all_levels", number(tile.faces), number(tile.limits.leastFaces), number(tile.limits.mostFaces));
  row("faces_distinct", number(tile.distinctFaces));
  for (const auto& [name, reading] : {std::pair{"n_at_most", terrain::LeafReading::atMost},
                                      std::pair{"n_at_least", terrain::LeafReading::atLeast}}) {
    const terrain::HalvedTree tree = terrain::halvedTree(kPublishedTriangles, kPublishedN, reading);
    const terrain::StaticLodLimits limits =
        terrain::staticLodLimits(kPublishedTriangles, kPublishedN, reading);
    row(std::string("published_levels_") + name, number(tree.levels), number(limits.levels));
    row(std::string("published_faces_") + name, number(tree.faces), number(limits.leastFaces),
        number(limits.mostFaces));
  }
  row("faces_ratio", number(tile.faces) / number(tile.triangles));
  row("locked_minima", number(tile.lockedMinima));
  for (std::size_t level = 0; level < tile.facesOfLevel.size(); ++level)
    row("faces_level_" + std::to_string(level), number(tile.facesOfLevel[level]), {}, {},
        tile.rmsErrorM[level], tile.maxErrorM[level]);

  const auto lines = linesOf(*trees, nearest, setup);
  if (!lines) return lines.findings();
  const std::vector<BuilderLevel> levels = treeLevels(*trees, nearest);
  const std::vector<BuilderLevel> patches = patchLevels(*setup.terrain, *trees, nearest);
  const auto surface = [&](const std::string& quantity, const SurfaceError& e) {
    row(quantity, number(e.triangles), {}, {}, e.rmsM, e.maxM, number(e.bytes));
  };
  for (const BuilderLevel& level : levels) {
    const std::string name = "_level_" + std::to_string(level.level);
    surface("tree" + name, level.error);
    const terrain::FanStatistics fans =
        terrain::fanStatistics(*trees, nearest, static_cast<std::uint32_t>(level.level));
    std::vector<Cell>& cells = report.measured.rows.back();
    const std::size_t firstOfFans = cells.size() - 4;
    cells[firstOfFans] = fans.trianglesPerStrip();
    cells[firstOfFans + 1] = fans.trianglesPerFan();
    cells[firstOfFans + 2] = fans.acmr16();
    cells[firstOfFans + 3] = fans.acmr32();
    if (const auto* same = ofNoMoreTriangles(patches, level.error.triangles))
      surface("patches_no_more_triangles" + name, same->error);
    if (const auto* same = ofNoGreaterRms(patches, level.error.rmsM); same && level.error.rmsM > 0)
      surface("patches_no_greater_rms" + name, same->error);
  }
  if (!patches.empty()) {
    const SurfaceError posts = postsError(*setup.terrain, *trees, nearest);
    row("posts_alone", number(setup.terrain->info().columns) * setup.terrain->info().rows, {}, {}, posts.rmsM,
        posts.maxM);
  }
  for (std::size_t level = 0; level < lines->kept.size() && level < lines->published.size(); ++level) {
    const auto share = [&](const char* quantity, const terrain::LineShare& s, double faces) {
      row(quantity + std::to_string(level), faces, {}, {}, {}, {}, {}, s.ofLines(), s.ofShores());
    };
    if (level < levels.size())
      share("lines_as_published_level_", lines->published[level], number(levels[level].error.triangles));
    share("lines_kept_level_", lines->kept[level], number(lines->keptFaces[level]));
  }

  char text[480];
  std::snprintf(text, sizeof text,
                "%s, tile %s: of %zu tiles the one whose triangles are nearest to the published %.0f.",
                setup.terrainName.c_str(), tile.tile.c_str(), trees->tiles.size(),
                number(kPublishedTriangles));
  report.notes = {text};
  report.notes.push_back(readings());
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
  Plot errors{
      "static-lod-errors", "Error against the source triangles", "triangles", "RMS error (m)", {}, {}};
  errors.logX = errors.logY = true;
  const auto line = [&](const char* name, const std::vector<BuilderLevel>& of) {
    Series series{name, {}, {}, Series::Draw::joined};
    std::vector<std::pair<double, double>> points;
    for (const BuilderLevel& level : of)
      if (level.error.rmsM > 0) points.push_back({number(level.error.triangles), level.error.rmsM});
    std::sort(points.begin(), points.end());
    for (const auto& [x, y] : points) series.x.push_back(x), series.y.push_back(y);
    errors.series.push_back(std::move(series));
  };
  line("document E's tree", levels);
  if (!patches.empty()) line("patches, all depths and variants", patches);
  report.plots = {plot, errors};
  report.notes.push_back(
      "Errors of both builders are vertical distances to the tile's source triangles, both ways: the "
      "source's vertices from the surface and the surface's from the source.");
  report.notes.push_back(
      "Strips and fans are greedy, end with their node, and keep materials apart; acmr_16 and acmr_32 are "
      "the "
      "vertices transformed per triangle with a FIFO cache of 16 and 32, empty at the start of each node, in "
      "the order that is stored.");
  if (patches.empty())
    report.notes.push_back("The database has no patches: bake it again to compare both builders.");
  return report;
}

}  // namespace trimtab::experiment
