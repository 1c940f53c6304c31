#include "source.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "arithmetic.h"
#include "cdb.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/scenery/made.h"
#include "trimtab/terrain/scenery/memory.h"
#include "trimtab/terrain/scenery/merge.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace {

/// A degree of latitude has so many metres on the sphere of equal volume.
constexpr double kMetresADegree = 111195;
constexpr const char* kArithmetic = "arithmetic";

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json recipeJson(const BakeOptions& options, const std::vector<fs::path>& files,
                const std::optional<ObjectSources>& objects) {
  Json recipe = {{"files", Json::array()}};
  for (const fs::path& file : files) {
    std::error_code error;
    recipe["files"].push_back(
        {{"name", file.filename().string()}, {"bytes", fs::file_size(containerOf(file), error)}});
  }
  if (options.imagery) recipe["imagery"] = options.imagery->filename().string();
  recipe["max_error_m"] = options.maxError ? Json(options.maxError->value()) : Json();
  recipe["post_m"] = options.post ? Json(options.post->value()) : Json();
  recipe["triangles_per_node"] = options.trianglesPerNode;
  if (options.reading.heightUnit) recipe["height_unit_m"] = *options.reading.heightUnit;
  if (options.reading.ignoreChecksums) recipe["ignore_checksums"] = true;
  if (options.keepLines) recipe["keep_lines"] = true;
  if (options.keepTexture) recipe["keep_texture"] = true;
  if (objects) {
    recipe["objects"] = {{"placements", objects->file.filename().string()},
                         {"fnv64", hexadecimal(objects->sum)},
                         {"models", Json::array()}};
    for (std::size_t i = 0; i < objects->models.size(); ++i)
      recipe["objects"]["models"].push_back(
          {{"name", objects->list.models[i]}, {"fnv64", hexadecimal(objects->modelSums[i])}});
  }
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

Result<std::vector<std::uint8_t>> BakeSource::image(const Progress& progress) const {
  if (!heights) return std::vector<std::uint8_t>{};
  return heights->image(progress);
}

Result<Done> BakeSource::makeTiles(const HeightSource& baked, const Progress& progress) {
  if (!between) return Done{};
  if (auto made = terrain::makeTiles(*tiles, baked, *between, progress); !made) return made;
  treesBytes += madeTilesBytes(tiles->counts().triangles - scenery->triangles);
  return Done{};
}

namespace {

/// Tiles are read as they are needed, and so is elevation beside them.
Result<std::unique_ptr<BakeSource>> openScenery(const BakeOptions& options, std::size_t memory,
                                                const Progress& progress) {
  std::vector<fs::path> sources = options.sources;
  const auto others = std::stable_partition(sources.begin(), sources.end(), isScenery);
  auto source = std::make_unique<BakeSource>();
  auto tiles = SceneryCatalogue::open({sources.begin(), others}, memory / 4, stageOf(progress, 0, 0.5));
  if (!tiles) return tiles.findings();
  Findings findings = tiles.findings();
  source->tiles = std::move(tiles).value();
  source->scenery = source->tiles->counts();
  std::unique_ptr<ElevationSource> elevation;
  if (others != sources.end()) {
    ElevationOptions elevationOptions;
    elevationOptions.reading = options.reading;
    elevationOptions.progress = stageOf(progress, 0.5, 0.6);
    auto opened = openElevation({others, sources.end()}, elevationOptions);
    if (!opened) return opened.findings();
    findings.insert(findings.end(), opened.findings().begin(), opened.findings().end());
    elevation = std::move(opened).value();
  }
  const auto posts = elevation ? postsOfBoth(*source->tiles, elevation->posts(), options.post)
                               : sceneryPosts(*source->tiles, options.post);
  if (!posts) {
    findings.insert(findings.end(), posts.findings().begin(), posts.findings().end());
    return findings;
  }
  if (elevation) source->between = elevationsPart(*posts, elevation->posts());
  auto heights =
      SceneryHeights::open(*source->tiles, *posts, stageOf(progress, 0.6, 1), std::move(elevation));
  findings.insert(findings.end(), heights.findings().begin(), heights.findings().end());
  if (!heights) return findings;
  source->heights = heights->get();
  source->elevation = std::move(heights).value();
  return Result<std::unique_ptr<BakeSource>>(std::move(source), std::move(findings));
}

}  // namespace

Result<std::unique_ptr<BakeSource>> readSource(const BakeOptions& options, std::size_t memory,
                                               const Progress& progress) {
  const auto scenery = std::count_if(options.sources.begin(), options.sources.end(), isScenery);
  if (scenery == 0) {
    ElevationOptions elevation;
    elevation.reading = options.reading;
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
  auto read = openScenery(options, memory, progress);
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
  if (hasError(findings)) return findings;
  return all;
}

namespace {

/// Place, size and time. What only GDAL reaches, such as a file in an archive, has a time in seconds.
std::string stampOf(const fs::path& file) {
  std::error_code error;
  if (VSIStatBufL there; !fs::exists(file, error) && VSIStatL(file.c_str(), &there) == 0)
    return file.string() + ' ' + std::to_string(there.st_size) + ' ' + std::to_string(there.st_mtime);
  const fs::path whole = fs::weakly_canonical(file, error), onDisk = containerOf(file);
  return whole.string() + ' ' + std::to_string(fs::file_size(onDisk, error)) + ' ' +
         std::to_string(fs::last_write_time(onDisk, error).time_since_epoch().count());
}

/// Adds the stamps of a file and of all files that GDAL reads with it; each may have such files of its own.
void addStamps(const fs::path& file, std::set<std::string>& seen, std::vector<std::string>& stamps) {
  std::string stamp = stampOf(file);
  if (!seen.insert(stamp).second) return;
  stamps.push_back(std::move(stamp));
  if (isScenery(file) || neverEnds(file)) return;
  std::vector<fs::path> files;
  {
    const GdalErrors quiet;
    const Dataset data = owned(GDALDataset::Open(containerOf(file).c_str(), GDAL_OF_RASTER));
    if (!data) return;
    char** const names = data->GetFileList();
    for (char** name = names; name != nullptr && *name != nullptr; ++name) files.emplace_back(*name);
    CSLDestroy(names);
  }
  for (const fs::path& other : files) addStamps(other, seen, stamps);
}

}  // namespace

std::vector<std::string> stampsOf(std::span<const fs::path> files) {
  useGdal();
  std::set<std::string> seen;
  std::vector<std::string> stamps;
  for (const fs::path& file : files) addStamps(file, seen, stamps);
  return stamps;
}

std::string recipeOf(const BakeOptions& options, const std::vector<fs::path>& files,
                     const std::optional<ObjectSources>& objects) {
  return dump(recipeJson(options, files, objects));
}

std::string stampedRecipe(const BakeOptions& options, const std::vector<fs::path>& files,
                          const std::optional<ObjectSources>& objects) {
  Json recipe = recipeJson(options, files, objects);
  recipe["format"] = kFormatVersion;
  recipe["builder"] = kBuilderVersion;
  recipe[kArithmetic] = arithmeticOfThisMachine();
  std::vector<fs::path> all = files;
  const std::vector<fs::path> images = imageFiles(options);
  all.insert(all.end(), images.begin(), images.end());
  recipe["stamps"] = stampsOf(all);
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
