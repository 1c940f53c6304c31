#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "trimtab/terrain/database.h"
#include "trimtab/terrain/import.h"
#include "trimtab/terrain/scenery.h"
#include "trimtab/terrain/scenery_import.h"
#include "trimtab/terrain/static_lod.h"
#include "trimtab/terrain/static_lod_sea.h"
#include "trimtab/terrain/store.h"
#include "trimtab/terrain/tiled_database.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// A folder beside the output that is gone again unless it takes the output's place.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(const fs::path& output) : output_(output) {
    static std::atomic<unsigned> count{0};
    path_ = output.parent_path() / ("." + output.filename().string() + ".part-" + std::to_string(::getpid()) +
                                    "-" + std::to_string(count++));
  }
  ~UnfinishedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  const fs::path& path() const { return path_; }

  std::error_code create() const {
    std::error_code error;
    if (!path_.parent_path().empty()) fs::create_directories(path_.parent_path(), error);
    fs::remove_all(path_, error);
    fs::create_directory(path_, error);
    return error;
  }
  /// The old database, where there is one, changes places with the new one and goes with this folder.
  std::error_code finish() const {
    std::error_code error;
    if (!fs::exists(output_, error)) {
      fs::rename(path_, output_, error);
      return error;
    }
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, output_.c_str(), RENAME_EXCHANGE) == 0) return {};
    const fs::path old = path_.string() + ".old";
    fs::rename(output_, old, error);
    if (!error) fs::rename(path_, output_, error);
    std::error_code ignored;
    fs::remove_all(old, ignored);
    return error;
  }

 private:
  fs::path output_, path_;
};

Finding refused(const fs::path& where, std::string expected, std::string found) {
  return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
}

/// Only a database or an empty folder may be replaced.
bool mayReplace(const fs::path& output) {
  std::error_code error;
  return !fs::exists(output, error) || isDatabase(output) ||
         (fs::is_directory(output, error) && fs::is_empty(output, error));
}

std::string joinedNames(const std::vector<fs::path>& sources) {
  std::string all;
  for (const fs::path& source : sources) all += (all.empty() ? "" : ", ") + source.string();
  return all;
}

std::string nameOf(const fs::path& path) {
  const fs::path last = path.has_filename() ? path.filename() : path.parent_path().filename();
  return (last.extension() == ".gz" ? last.stem() : last).stem().string();
}

/// What the sources hold, by either import.
struct Source {
  HeightGrid grid;
  std::uint64_t voidsFilled = 0;
  std::optional<SceneryCounts> scenery;
  std::vector<SceneryMesh> meshes;
};

/// An image over the colours of materials: those stay where it has nothing.
void drape(std::vector<std::uint8_t> image, std::vector<std::uint8_t>& under) {
  if (under.empty()) {
    under = std::move(image);
    return;
  }
  for (std::size_t i = 0; i + 3 < image.size(); i += 4)
    if (image[i + 3] != 0) std::copy_n(&image[i], 4, &under[i]);
}

Result<Source> readSource(const BakeOptions& options, const Progress& progress) {
  const auto scenery = std::count_if(options.sources.begin(), options.sources.end(), isScenery);
  if (scenery == 0) {
    auto imported = importElevation(options.sources, progress);
    if (!imported) return imported.findings();
    return {Source{std::move((*imported).grid), imported->voidsFilled, {}, {}}, imported.findings()};
  }
  if (scenery != static_cast<std::ptrdiff_t>(options.sources.size()))
    return refused("bake", "elevation or scenery", "both");
  auto imported = importScenery(options.sources, options.post, progress);
  if (!imported) return imported.findings();
  return {Source{std::move((*imported).grid), imported->voidsFilled, std::move((*imported).counts),
                 std::move((*imported).meshes)},
          imported.findings()};
}

}  // namespace

bool isDatabase(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kManifestName, error);
}

Result<std::shared_ptr<const Database>> bake(const BakeOptions& options) {
  if (options.sources.empty()) return refused("bake", "at least one elevation file", "none");
  const fs::path output = options.output.has_filename() ? options.output : options.output.parent_path();
  if (output.empty()) return refused("bake", "an output folder", "none");
  if (!mayReplace(output))
    return refused(output, "a new folder, an empty one or a terrain database",
                   "something else, left as it is");
  // What is not scenery is done at 1; its trees take three quarters of the time.
  double share = std::any_of(options.sources.begin(), options.sources.end(), isScenery) ? 0.25 : 1;
  const auto stage = [&](double from, double to) -> Progress {
    return [&options, from = from * share, to = to * share](double fraction, const std::string& what) {
      return !options.progress || options.progress(from + (to - from) * fraction, what);
    };
  };

  auto imported = readSource(options, stage(0, 0.35));
  if (!imported) return imported.findings();
  Findings findings = imported.findings();
  HeightGrid& grid = (*imported).grid;
  if (options.imagery) {
    auto image = readImagery(*options.imagery, grid.posts, stage(0.35, 0.5));
    findings.insert(findings.end(), image.findings().begin(), image.findings().end());
    if (!image) return findings;
    drape(std::move(image).value(), grid.image);
  }

  TerrainIndex index = makeLevels(grid.posts);
  CellSlopes slopes(index);
  const PostGeometry geometry(grid.posts);
  const Progress measuring = stage(0.5, 0.9);
  if (!measureLevels(grid.posts, grid.heights, geometry, index, slopes,
                     [&](double f) { return measuring(f, "measuring levels"); }))
    return cancelled("measuring levels");

  const auto [lowest, highest] = std::minmax_element(grid.heights.begin(), grid.heights.end());
  TerrainInfo info;
  info.name = nameOf(options.sources.front());
  if (options.sources.size() > 1) info.name += " and " + std::to_string(options.sources.size() - 1) + " more";
  info.source = joinedNames(options.sources);
  if (options.imagery) info.source += ", " + options.imagery->string();
  info.lowest = Metres{*lowest};
  info.highest = Metres{*highest};
  info.voidsFilled = imported->voidsFilled;
  info.scenery = imported->scenery;
  Contents contents{info, std::move(grid), std::move(index), std::move(slopes), {}};
  if (!imported->meshes.empty()) {
    StaticLodOptions trees;
    trees.trianglesPerNode = options.trianglesPerNode;
    trees.progress = [&](double fraction, const std::string& what) {
      return !options.progress || options.progress(0.225 + 0.75 * fraction, what);
    };
    auto built = buildStaticLod(imported->meshes, geometry.frame(), trees);
    findings.insert(findings.end(), built.findings().begin(), built.findings().end());
    if (!built) return findings;
    contents.staticLod = withOpenSea(*built, imported->meshes, contents.grid);
    share = 1;
    (*imported).meshes.clear();
  }

  const UnfinishedFolder unfinished(output);
  if (const auto error = unfinished.create())
    return refused(unfinished.path(), "a folder that can be written", error.message());
  if (auto written = writeContents(unfinished.path(), contents); !written) return written.findings();
  if (!stage(0.9, 1)(1, "writing")) return cancelled(output.string());
  std::error_code error;
  for (const auto& file : fs::directory_iterator(unfinished.path(), error))
    contents.info.bytes += fs::file_size(file, error);
  if ((error = unfinished.finish())) return refused(output, "a place to put the database", error.message());
  return Result<std::shared_ptr<const Database>>(makeDatabase(std::move(contents)), std::move(findings));
}

Result<std::shared_ptr<const Database>> openOrBake(const fs::path& source, const fs::path& cacheFolder,
                                                   const Progress& progress, std::uint32_t trianglesPerNode) {
  if (isDatabase(source)) return Database::open(source);
  const std::vector<fs::path> sources{source};
  const bool scenery = isScenery(source);
  const auto files = scenery ? sceneryFiles(source) : elevationFiles(sources);
  if (!files) return files.findings();
  std::string key = "v" + std::to_string(kFormatVersion);
  if (scenery) key += " n" + std::to_string(trianglesPerNode);
  for (const fs::path& file : *files) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(file, error);
    key += '\n' + whole.string() + ' ' + std::to_string(fs::file_size(file, error)) + ' ' +
           std::to_string(fs::last_write_time(file, error).time_since_epoch().count());
  }
  const std::string name = nameOf(source);
  const fs::path cached = cacheFolder / (name + "-" + hexadecimal(checksum(key)));
  if (isDatabase(cached)) {
    // A damaged copy is made again.
    if (auto database = Database::open(cached)) return database;
  }
  BakeOptions options;
  options.sources = sources;
  options.output = cached;
  options.trianglesPerNode = trianglesPerNode;
  options.progress = progress;
  return bake(options);
}

}  // namespace trimtab::terrain
