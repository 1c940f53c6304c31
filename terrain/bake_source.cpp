#include "trimtab/terrain/bake_source.h"

#include <gdal.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "trimtab/terrain/arithmetic.h"
#include "trimtab/terrain/bake_heights.h"
#include "trimtab/terrain/import.h"
#include "trimtab/terrain/scenery_import.h"
#include "trimtab/terrain/scenery_memory.h"
#include "trimtab/terrain/scenery_merge.h"
#include "trimtab/terrain/store.h"

namespace trimtab::terrain {

namespace {

/// Of latitude, on the sphere of equal volume.
constexpr double kMetresADegree = 111195;
constexpr const char* kArithmetic = "arithmetic";

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json recipeJson(const BakeOptions& options, const std::vector<fs::path>& files) {
  Json recipe = {{"files", Json::array()}};
  for (const fs::path& file : files) {
    std::error_code error;
    recipe["files"].push_back({{"name", file.filename().string()}, {"bytes", fs::file_size(file, error)}});
  }
  if (options.imagery) recipe["imagery"] = options.imagery->filename().string();
  recipe["max_error_m"] = options.maxError ? Json(options.maxError->value()) : Json();
  recipe["post_m"] = options.post ? Json(options.post->value()) : Json();
  recipe["triangles_per_node"] = options.trianglesPerNode;
  if (options.keepLines) recipe["keep_lines"] = true;
  return recipe;
}

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string joinedNames(const std::vector<fs::path>& sources) {
  std::string all;
  for (const fs::path& source : sources) all += (all.empty() ? "" : ", ") + source.string();
  return all;
}

std::string nameOf(const fs::path& path) {
  const fs::path last = path.has_filename() ? path.filename() : path.parent_path().filename();
  return (last.extension() == ".gz" ? last.stem() : last).stem().string();
}

Result<std::vector<std::uint8_t>> BakeSource::takeImage(const Progress& progress) {
  if (heights) return heights->image(progress);
  return std::move(grid.image);
}

namespace {

/// Scenery alone: its tiles are read as they are needed.
Result<std::unique_ptr<BakeSource>> openScenery(const BakeOptions& options, std::size_t memory,
                                                const Progress& progress) {
  auto source = std::make_unique<BakeSource>();
  auto tiles = SceneryCatalogue::open(options.sources, memory / 4, stageOf(progress, 0, 0.6));
  if (!tiles) return tiles.findings();
  Findings findings = tiles.findings();
  source->tiles = std::move(tiles).value();
  source->scenery = source->tiles->counts();
  const auto posts = sceneryPosts(*source->tiles, options.post);
  if (!posts) {
    findings.insert(findings.end(), posts.findings().begin(), posts.findings().end());
    return findings;
  }
  auto heights = SceneryHeights::open(*source->tiles, *posts, stageOf(progress, 0.6, 1));
  findings.insert(findings.end(), heights.findings().begin(), heights.findings().end());
  if (!heights) return findings;
  source->heights = heights->get();
  source->elevation = std::move(heights).value();
  return Result<std::unique_ptr<BakeSource>>(std::move(source), std::move(findings));
}

/// Scenery beside elevation is read whole: better to say so now than when memory has run out.
Result<std::unique_ptr<BakeSource>> openMerged(const BakeOptions& options, const std::vector<fs::path>& files,
                                               std::size_t memory, const Progress& progress) {
  const std::uint64_t bytes = sceneryBytes(files) + sceneryPostsBytes(files, options.post);
  if (bytes > memory)
    return Finding{
        Severity::error, nameOf(options.sources.front()), "memory",
        "room for all of this scenery beside elevation: about " + std::to_string(bytes / 1000000 + 1) + " MB",
        std::to_string(memory / 1000000) +
            " MB allowed: allow more, choose fewer tiles or posts farther apart, or bake scenery alone"};
  std::vector<fs::path> sources = options.sources;
  const auto elevation = std::stable_partition(sources.begin(), sources.end(), isScenery);
  auto merged =
      importMerged({sources.begin(), elevation}, {elevation, sources.end()}, options.post, progress);
  if (!merged) return merged.findings();
  auto source = std::make_unique<BakeSource>();
  source->grid = std::move((*merged).grid);
  source->voidsFilled = merged->voidsFilled;
  source->scenery = std::move((*merged).counts);
  source->tiles = std::move((*merged).tiles);
  source->elevation = sourceOf(source->grid);
  return Result<std::unique_ptr<BakeSource>>(std::move(source), merged.findings());
}

}  // namespace

Result<std::unique_ptr<BakeSource>> readSource(const BakeOptions& options, std::size_t memory,
                                               const Progress& progress) {
  const auto scenery = std::count_if(options.sources.begin(), options.sources.end(), isScenery);
  if (scenery == 0) {
    ElevationOptions elevation;
    elevation.progress = progress;
    if (options.post) elevation.stepLatitude = options.post->value() / kMetresADegree;
    auto opened = openElevation(options.sources, elevation);
    if (!opened) return opened.findings();
    const Findings findings = opened.findings();
    auto source = std::make_unique<BakeSource>();
    source->elevation = std::move(opened).value();
    return Result<std::unique_ptr<BakeSource>>(std::move(source), findings);
  }
  const auto files = sourceFiles(options.sources);
  if (!files) return files.findings();
  const bool alone = static_cast<std::size_t>(scenery) == options.sources.size();
  auto read = alone ? openScenery(options, memory, progress) : openMerged(options, *files, memory, progress);
  if (read) (*read)->treesBytes = sceneryBytes(*files);
  return read;
}

Result<std::vector<fs::path>> sourceFiles(const std::vector<fs::path>& sources) {
  std::vector<fs::path> all;
  Findings findings;
  for (const fs::path& source : sources) {
    const auto files = isScenery(source) ? sceneryFiles(source) : elevationFiles(std::span(&source, 1));
    findings.insert(findings.end(), files.findings().begin(), files.findings().end());
    if (files) all.insert(all.end(), files->begin(), files->end());
  }
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& f) { return f.severity == Severity::error; }))
    return findings;
  return all;
}

std::string stampOf(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(file, error);
  return whole.string() + ' ' + std::to_string(fs::file_size(file, error)) + ' ' +
         std::to_string(fs::last_write_time(file, error).time_since_epoch().count());
}

std::string recipeOf(const BakeOptions& options, const std::vector<fs::path>& files) {
  return dump(recipeJson(options, files));
}

std::string stampedRecipe(const BakeOptions& options, const std::vector<fs::path>& files) {
  Json recipe = recipeJson(options, files);
  recipe["format"] = kFormatVersion;
  recipe["builder"] = kBuilderVersion;
  recipe[kArithmetic] = arithmeticOfThisMachine();
  recipe["stamps"] = Json::array();
  for (const fs::path& file : files) recipe["stamps"].push_back(stampOf(file));
  if (options.imagery) recipe["stamps"].push_back(stampOf(*options.imagery));
  return dump(recipe);
}

bool sameButForArithmetic(const std::string& stampedRecipe, const std::string& other) {
  Json a = Json::parse(stampedRecipe, nullptr, false), b = Json::parse(other, nullptr, false);
  if (!a.is_object() || !b.is_object()) return false;
  a.erase(kArithmetic);
  b.erase(kArithmetic);
  return a == b;
}

RasterCacheLimit::RasterCacheLimit(std::size_t bytes) : before_(GDALGetCacheMax64()) {
  GDALSetCacheMax64(std::min(before_, static_cast<std::int64_t>(bytes)));
}

RasterCacheLimit::~RasterCacheLimit() {
  GDALSetCacheMax64(before_);
}

}  // namespace trimtab::terrain
