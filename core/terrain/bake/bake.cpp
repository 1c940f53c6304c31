#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <future>
#include <thread>

#include "cdb.h"
#include "ground.h"
#include "heights.h"
#include "objects.h"
#include "patches.h"
#include "source.h"
#include "stages.h"
#include "tiles.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/imagery.h"
#include "trimtab/terrain/ground/triangles.h"
#include "trimtab/terrain/patches/build.h"
#include "trimtab/terrain/scenery/scenery.h"
#include "trimtab/terrain/static_lod/sea.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "work.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

Finding refused(const fs::path& where, std::string expected, std::string found) {
  return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
}

/// Returns as a finding what is thrown for want of memory or threads: what is done by then stays done.
template <class Work>
auto orFinding(const fs::path& where, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& thrown) {
    return refused(where, "memory and threads enough to bake", thrown.what());
  }
}

/// Patches and ground are made at the same time where they may take so much, bytes.
constexpr std::size_t kBesideBytes = std::size_t{512} << 20;

/// Bakes from the options to one of three ends: a database, a part of the work, a database of parts.
class Job {
 public:
  explicit Job(const BakeOptions& options)
      : options_(options),
        output_(options.output.has_filename() ? options.output : options.output.parent_path()),
        memory_(static_cast<std::size_t>(std::max(64.0, options.memory.value()) * 1e6)) {}

  Result<std::shared_ptr<const Database>> whole(bool join) {
    auto made = makeWhole(join);
    return made ? made : withRest(made.findings());
  }

  Result<Done> part(std::uint32_t part, std::uint32_t parts) {
    auto made = makeOnePart(part, parts);
    return made ? made : withRest(made.findings());
  }

 private:
  /// Names the work that is kept when a bake ends early: it may be what fills the disk.
  Findings withRest(Findings why) const {
    if (work_ && !work_->journal().empty()) why.push_back(work_->kept());
    return why;
  }

  Result<std::shared_ptr<const Database>> makeWhole(bool join) {
    if (auto begun = begin(join ? WorkFolder::Use::join : WorkFolder::Use::alone); !begun)
      return begun.findings();
    if (join && (!work_ || someMissing())) return Result<std::shared_ptr<const Database>>(nullptr, findings_);
    if (!join)
      if (auto made = makePart(0, 1, true); !made) return made.findings();
    if (auto made = kept(finish(join)); !made) return made.findings();
    auto database = Database::open(output_);
    if (!database) return database;
    return Result<std::shared_ptr<const Database>>(*database, findings_);
  }

  Result<Done> makeOnePart(std::uint32_t part, std::uint32_t parts) {
    if (parts > kMostBakeParts)
      return refused("bake", "at most " + std::to_string(kMostBakeParts) + " parts", std::to_string(parts));
    if (part < 1 || part > parts)
      return refused("bake", "a part from 1 to " + std::to_string(parts), std::to_string(part));
    if (auto begun = begin(WorkFolder::Use::part); !begun) return begun.findings();
    if (auto made = makePart(part - 1, parts, false); !made) return made.findings();
    return Result<Done>(Done{}, findings_);
  }

  Progress stage(Stage stage, double from = 0, double to = 1) const {
    return progressOf(options_.progress, scenery_ ? kSceneryShares : kElevationShares, stage, from, to);
  }
  void keep(const Findings& findings) { findings_.insert(findings_.end(), findings.begin(), findings.end()); }
  Result<Done> kept(Result<Done> done) {
    if (done) keep(done.findings());
    return done;
  }

  Result<Done> mayTakePlace() const {
    if (mayReplace(output_)) return Done{};
    return refused(output_, "a new folder, an empty one or a terrain database with nothing beside it",
                   "something else, left as it is");
  }

  /// Does everything up to the heights in their file.
  Result<Done> begin(WorkFolder::Use use) {
    if (options_.sources.empty()) return refused("bake", "at least one elevation file", "none");
    if (output_.empty()) return refused("bake", "an output folder", "none");
    if (auto may = mayTakePlace(); !may) return may;
    const auto files = sourceFiles(options_.sources);
    if (!files) return files.findings();
    auto objects = readObjectSources(options_, memory_);
    if (!objects) return objects.findings();
    keep(objects.findings());
    objects_ = std::move(objects).value();
    recipe_ = recipeOf(options_, *files, objects_);
    auto work = WorkFolder::open(output_, stampedRecipe(options_, *files, objects_), use);
    if (!work) return work.findings();
    keep(work.findings());
    work_ = std::move(work).value();
    if (!work_) return Done{};  // nothing to join yet
    // This is asked before other parts of the same bake come to write there.
    goesOn_ = work_->resumed() && !work_->journal().empty();
    scenery_ = std::any_of(options_.sources.begin(), options_.sources.end(), isScenery);
    auto source = readSource(options_, memory_, stage(Stage::source));
    if (!source) return source.findings();
    keep(source.findings());
    source_ = std::move(source).value();
    if (Findings beyond = beyondLimits(source_->elevation->posts(),
                                       files->size() == 1 ? files->front().string() : "all files together");
        !beyond.empty())
      return beyond;
    // One process makes the heights; other parts wait for them.
    std::unique_ptr<FileLock> turn;
    const fs::path turnFile = work_->path() / "heights.lock";
    while (!(turn = FileLock::tryLock(turnFile, false))) {
      if (const int reason = errno; reason != EWOULDBLOCK)
        return refused(turnFile, "a file that can be locked", std::strerror(reason));
      if (!stage(Stage::heights)(0, "waiting for the part that reads the heights"))
        return cancelled("waiting");
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    if (auto same = keepToPosts(use); !same) return same;
    auto heights = bakeHeights(*work_, *source_->elevation, memory_, stage(Stage::heights));
    if (!heights) return heights.findings();
    heights_ = *heights;
    keep(sharesOf(source_->elevation->names(), heights_.given));
    if (heights_.outside > 0)
      findings_.push_back({Severity::note, files->front().string(), "outline",
                           scenery_ ? "tiles over the whole rectangle of the terrain"
                                    : "elevation over the whole rectangle of the terrain",
                           std::to_string(heights_.outside) + " posts beyond it, continued from its edge"});
    auto opened = FileHeights::open(*work_, heights_);
    if (!opened) return opened.findings();
    file_ = std::move(opened).value();
    if (auto made = source_->makeTiles(*file_, stage(Stage::scenery)); !made) return made;
    geometry_ = std::make_unique<PostGeometry>(heights_.posts);
    const double leafM =
        options_.maxError ? options_.maxError->value() : defaultLeafToleranceM(heights_.posts);
    patches_ = std::make_unique<PatchBake>(*work_, heights_.posts, *geometry_, leafM);
    GroundSources ground;
    ground.heights = file_.get();
    ground.geometry = geometry_.get();
    ground.memory = memory_ / 2;  // patches may be made beside it
    const auto images = imagesOver(options_, heights_.posts);
    keep(images.findings());
    if (!images) return images.findings();
    images_ = ground.images = *images;
    if (source_->tiles)
      ground.triangles =
          &materials_.emplace(*source_->tiles, heights_.posts.longitude((heights_.posts.columns - 1) / 2.0));
    ground_ = std::make_unique<GroundBake>(*work_, std::move(ground));
    tiles_ = std::make_unique<TileBake>(*work_, heights_.posts, *geometry_);
    return Done{};
  }

  /// Finished work is of these posts, or goes; not where it is parts'.
  Result<Done> keepToPosts(WorkFolder::Use use) {
    const PostGrid& posts = source_->elevation->posts();
    const std::string others = workForOtherPosts(*work_, posts);
    if (!others.empty() && use != WorkFolder::Use::alone)
      return refused(work_->path(), "parts of one grid, here of " + inWords(posts),
                     others +
                         ", left as they are: bake these parts of the sources as they were, or remove the "
                         "folder and bake all parts again");
    if (!others.empty())
      if (auto emptied = kept(work_->beginAnew()); !emptied) return emptied;
    if (goesOn_ && work_->resumed())
      findings_.push_back({Severity::note, output_.string(), "", "", "goes on from an interrupted bake"});
    return Done{};
  }

  /// Call it after whatever reads heights: what could not be read is 0 m there.
  Result<Done> allRead() const {
    if (file_->failed()) return unreadable((work_->database() / kHeightsName).string());
    return Done{};
  }

  /// Patches and ground of a share, and of the whole what its tiles are drawn by.
  Result<Done> makePart(std::uint32_t part, std::uint32_t parts, bool whole) {
    // Side by side, where memory holds both: the ground is one core's work for long, and patches, in many
    // small pieces, take whatever time of the cores is left.
    const bool beside = memory_ >= kBesideBytes;
    const Progress patches = stage(Stage::patches);
    const Progress ground = stage(Stage::ground);
    std::atomic<bool> stop{false}, failed{false};
    std::atomic<double> share{0};
    // Only this thread reports progress.
    const Progress other = [&](double done, const std::string& what) {
      share = done;
      return beside ? !stop : ground(done, what);
    };
    auto made = std::async(beside ? std::launch::async : std::launch::deferred, [&]() -> Result<Done> {
      auto done = ground_->make(part, parts, other);
      if (done && beside && whole && tileBytes() <= memory_ / 4) done = tiles_->measure(other);
      failed = !done;
      return done;
    });
    // However this ends, the other thread is not left at what nobody wants.
    const std::unique_ptr<std::atomic<bool>, void (*)(std::atomic<bool>*)> stopper(
        &stop, [](std::atomic<bool>* flag) { *flag = true; });
    auto result =
        patches_->make(*file_, part, parts, beside ? memory_ / 2 : memory_,
                       [&](double done, const std::string& what) { return !failed && patches(done, what); });
    if (result || failed) {
      while (made.wait_for(std::chrono::milliseconds(50)) == std::future_status::timeout)
        if (!ground(share, "the ground's colours")) stop = true;
      result = made.get();
    }
    const auto read = allRead();
    return read ? result : read;
  }

  /// Reports whether parts are not finished, and notes what is missing.
  bool someMissing() {
    const auto there = patches_->finished();
    const auto missing = std::count(there.begin(), there.end(), std::uint8_t{0});
    const auto note = [this](std::string expected, std::string found) {
      findings_.push_back(
          {Severity::note, work_->path().string(), "", std::move(expected), std::move(found)});
      return true;
    };
    if (missing > 0)
      return note("all " + std::to_string(there.size()) + " pieces of the parts",
                  std::to_string(missing) + " missing: let every part end, then join");
    return ground_->parts() == 0 &&
           note("the ground of all parts of one number of parts", "some of them missing");
  }

  /// The slopes of all levels, and the colours, take so many bytes.
  std::size_t tileBytes() const {
    const std::size_t posts = heights_.posts.size(),
                      images = (images_.empty() ? 0 : 1) + (source_->tiles ? 1 : 0);
    return posts * 4 / 3 + images * posts * 4;
  }
  /// Nodes, slopes and colours of tiles, where the grid has them.
  Result<Done> makeTiles() {
    const PostGrid& posts = heights_.posts;
    if (posts.size() > kMostTiledPosts) return Done{};
    if (tileBytes() > memory_) {
      findings_.push_back({Severity::note, output_.string(), "tiles",
                           std::to_string(tileBytes() / 1000000 + 1) + " MB of memory for them",
                           std::to_string(memory_ / 1000000) + " MB: left out, patches are drawn"});
      return Done{};
    }
    if (auto done = tiles_->measure(stage(Stage::tiles, 0, 0.7)); !done) return done;
    if (auto done = put(tiles_->write()); !done) return done;
    auto colours = source_->image(stage(Stage::tiles, 0.7, 0.85));
    if (!colours) return colours.findings();
    std::vector<std::uint8_t> image = std::move(colours).value();
    if (!images_.empty()) {
      auto read = readImagery(images_, posts, stage(Stage::tiles, 0.85, 1));
      if (!read) return read.findings();
      drape(std::move(read).value(), image);
    }
    if (image.empty()) return Done{};
    hasImage_ = true;
    return put(tiles_->writeImage(image));
  }

  Result<Done> put(const Result<std::vector<FileEntry>>& files) {
    if (!files) return files.findings();
    files_.insert(files_.end(), files->begin(), files->end());
    return Done{};
  }
  Result<Done> putPages(const char* name) {
    const auto pages = PageFile::open(work_->database() / name);
    if (!pages) return pages.findings();
    files_.push_back({name, (*pages)->bytes(), (*pages)->checksum()});
    return Done{};
  }

  Result<Done> makeTrees() {
    if (!source_->tiles) return Done{};
    // Texture coordinates of the source, of the trees and of the triangles that are being simplified.
    constexpr std::uint64_t kTextureBytes = 100;
    std::uint64_t treesBytes = source_->treesBytes;
    if (options_.keepTexture) treesBytes += kTextureBytes * source_->tiles->counts().triangles;
    if (treesBytes > memory_) {
      findings_.push_back({Severity::note, output_.string(), "trees",
                           std::to_string(treesBytes / 1000000 + 1) + " MB of memory for them",
                           std::to_string(memory_ / 1000000) + " MB: left out, patches are drawn"});
      return Done{};
    }
    const auto meshes = source_->tiles->takeAll(options_.keepTexture);
    if (!meshes) return meshes.findings();
    StaticLodOptions trees;
    trees.trianglesPerNode = options_.trianglesPerNode;
    trees.keepLines = options_.keepLines;
    trees.progress = stage(Stage::trees);
    auto built = buildStaticLod(*meshes, geometry_->frame(), trees);
    if (!built) return built.findings();
    keep(built.findings());
    const auto withSea = withOpenSea(*built, *meshes, *file_);
    if (auto read = allRead(); !read) return read;
    trianglesPerNode_ = withSea->trianglesPerNode;
    const fs::path file = work_->database() / kStaticLodName;
    if (auto written = writeStaticLod(file, *withSea); !written) return written.findings();
    std::error_code error;
    files_.push_back({kStaticLodName, fs::file_size(file, error), {}});
    return Done{};
  }

  Result<Done> makeObjects() {
    if (!objects_) return Done{};
    const auto objects = bakeObjects(*objects_, *file_, work_->database() / kPatchesName, geometry_->frame(),
                                     stage(Stage::objects));
    objects_.reset();
    if (!objects) return objects.findings();
    keep(objects.findings());
    if (auto read = allRead(); !read) return read;
    if (objects->index.instances.empty()) return Done{};
    const fs::path file = work_->database() / kObjectsName;
    const auto sum = writeObjects(file, *objects);
    if (!sum) return sum.findings();
    std::error_code error;
    files_.push_back({kObjectsName, fs::file_size(file, error), *sum});
    return Done{};
  }

  Result<Done> finish(bool join) {
    std::error_code error;
    if (auto cleared = kept(work_->clearDatabase()); !cleared) return cleared;
    if (auto done = patches_->join(work_->database() / kPatchesName, stage(Stage::tiles, 0, 0)); !done)
      return done;
    const auto ground = ground_->join(join ? ground_->parts() : 1, work_->database() / kGroundName,
                                      stage(Stage::tiles, 0, 0));
    if (!ground) return ground;
    keep(ground.findings());
    for (const char* name : {kPatchesName, kGroundName})
      if (auto done = putPages(name); !done) return done;
    const std::uint64_t bytes = std::uint64_t{heights_.posts.size()} * sizeof(float);
    files_.push_back({kHeightsName, bytes, heights_.sum});
    const auto sums = fs::file_size(work_->database() / kHeightSumsName, error);
    files_.push_back({kHeightSumsName, sums, heights_.sum});
    const auto sources = bakeSources(*work_, heights_.posts, source_->elevation->names());
    if (!sources) return sources.findings();
    if (*sources) files_.push_back(**sources);
    if (auto done = makeTiles(); !done) return done;
    if (auto done = makeObjects(); !done) return done;
    // Last: these take scenery's tiles for themselves.
    if (auto done = makeTrees(); !done) return done;

    TerrainInfo info;
    info.name = nameOf(options_.sources.front());
    if (options_.sources.size() > 1)
      info.name += " and " + std::to_string(options_.sources.size() - 1) + " more";
    info.source = joinedNames(options_.sources);
    for (const auto& also : {options_.imagery, options_.objects})
      if (also) info.source += ", " + also->string();
    info.lowest = Metres{heights_.lowest};
    info.highest = Metres{heights_.highest};
    info.voidsFilled = heights_.voids;
    info.scenery = source_->scenery;
    info.hasImage = hasImage_ || !images_.empty();
    std::sort(files_.begin(), files_.end(),
              [](const FileEntry& a, const FileEntry& b) { return a.name < b.name; });
    if (auto written =
            writeManifest(work_->database(), info, heights_.posts, files_, trianglesPerNode_, recipe_);
        !written)
      return written;
    if (!stage(Stage::writing)(1, "writing")) return cancelled(output_.string());
    // An existing database is not given up for one that cannot be opened.
    if (auto opened = Database::open(work_->database()); !opened) {
      Findings why = opened.findings();
      why.push_back({Severity::error, output_.string(), "",
                     "a database that can be opened, to take this place",
                     "one that cannot; what was there is as it was"});
      return why;
    }
    // Whoever put something there meanwhile keeps it.
    if (auto may = mayTakePlace(); !may) return may;
    return work_->finish(output_);
  }

  const BakeOptions& options_;
  fs::path output_;
  std::size_t memory_;
  RasterCacheLimit cache_{memory_ / 8};
  Findings findings_;
  std::string recipe_;
  std::unique_ptr<WorkFolder> work_;
  bool goesOn_ = false, scenery_ = false, hasImage_ = false;
  std::unique_ptr<BakeSource> source_;
  BakedHeights heights_;
  std::unique_ptr<FileHeights> file_;
  std::unique_ptr<PostGeometry> geometry_;
  std::unique_ptr<PatchBake> patches_;
  std::optional<SceneryGround> materials_;  ///< where the source is scenery
  std::unique_ptr<GroundBake> ground_;
  std::unique_ptr<TileBake> tiles_;
  std::vector<FileEntry> files_;
  std::vector<fs::path> images_;  ///< of the imagery, those over the terrain
  std::optional<std::uint32_t> trianglesPerNode_;
  std::optional<ObjectSources> objects_;  ///< until they are placed
};

}  // namespace

Result<std::shared_ptr<const Database>> bake(const BakeOptions& options) {
  return orFinding(options.output, [&] { return Job(options).whole(false); });
}
Result<std::shared_ptr<const Database>> bakeJoin(const BakeOptions& options) {
  return orFinding(options.output, [&] { return Job(options).whole(true); });
}
Result<Done> bakePart(const BakeOptions& options, std::uint32_t part, std::uint32_t parts) {
  return orFinding(options.output, [&] { return Job(options).part(part, parts); });
}

}  // namespace trimtab::terrain
