#include "trimtab/terrain/ground/build.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "paint.h"
#include "texels.h"
#include "tree.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/image.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;
using Place = GroundPlace;

constexpr std::uint32_t kTile = GroundShape::kTile;
/// Colours are read for this level's tiles at a time, and threads take no less.
constexpr std::uint32_t kBlockLevel = 2;
/// A block takes so much while it is made, with its colours and the windows of images, or waits for its turn.
constexpr std::size_t kBytesABlock = std::size_t{32} << 20;

using AddBlob = std::function<Result<Done>(std::uint64_t key, std::span<const std::byte> blob)>;
struct Blob {
  std::uint64_t key;
  std::vector<std::byte> bytes;
};
/// Makes the tiles of a block, by many threads at once. Tiles are counted in levels of at least a texel a
/// post; those that are finer than wanted (`skipped` of them) are made and not kept.
class Blocks {
 public:
  static Result<std::unique_ptr<Blocks>> make(const GroundSources& sources) {
    auto blocks = std::unique_ptr<Blocks>(new Blocks(sources));
    Findings notes;
    double finest = 0;
    const PostGrid& posts = sources.heights->posts();
    for (const fs::path& file : sources.images) {
      auto image = GroundImage::open(file);
      notes.insert(notes.end(), image.findings().begin(), image.findings().end());
      if (!image) return notes;
      if (!(*image)->touches(posts)) {
        notes.push_back({Severity::error, file.string(), "georeference", "an image over the terrain",
                         "none of its ground covered"});
        return notes;
      }
      const double step = (*image)->stepDegrees();
      if (step > 0 && (finest == 0 || step < finest)) finest = step;
      blocks->images_.push_back(std::move(image).value());
    }
    double texels = sources.triangles == nullptr ? 1 : 2;
    // An image a little finer than the posts keeps their grid: up to half an octave is given away.
    if (finest > 0)
      texels = std::clamp(std::exp2(std::round(std::log2(posts.stepLatitude / finest))), texels,
                          std::max(sources.mostTexelsPerPost, texels));
    blocks->setLevels(sources.texelsPerPost.value_or(texels));
    blocks->covered_ = std::vector<std::atomic<std::uint64_t>>(blocks->images_.size());
    return Result<std::unique_ptr<Blocks>>(std::move(blocks), std::move(notes));
  }

  const GroundShape& shape() const { return shape_; }
  const std::vector<GroundShape::Level>& levels() const { return levels_; }
  std::uint32_t skipped() const { return skipped_; }

  /// Returns all blocks in the order of their tiles in a file.
  std::vector<Place> all() const {
    std::vector<Place> blocks;
    gather({static_cast<std::uint32_t>(levels_.size()) - 1, 0, 0}, blocks);
    return blocks;
  }

  /// Returns the place at or after `i` in this order where a share may end: no tile that is kept lies in two
  /// shares whose children are not kept.
  std::size_t boundary(std::span<const Place> places, std::size_t i) const {
    const std::uint32_t up = std::max(skipped_, blockLevel_) - blockLevel_;
    const auto together = [&](const Place& a, const Place& b) {
      return a.column >> up == b.column >> up && a.row >> up == b.row >> up;
    };
    while (i > 0 && i < places.size() && together(places[i - 1], places[i])) ++i;
    return i;
  }

  struct Built {
    GroundTile top;
    std::vector<Blob> blobs;  ///< that are kept, children before their parents
  };
  Result<Built> build(const Place& block) const {
    Built built;
    const auto colours = coloursOf(block);
    if (!colours) return colours.findings();
    auto top = tile(block, block, *colours, built.blobs);
    if (!top) return top.findings();
    built.top = std::move(top).value();
    return built;
  }

  GroundCover cover() const {
    GroundCover cover{std::uint64_t{levels_[0].columns} * levels_[0].rows, coveredByAny_, {}};
    for (const auto& covered : covered_) cover.covered.push_back(covered.load());
    return cover;
  }

  void keep(std::vector<Blob>& blobs, const Place& place, const GroundTile& tile) const {
    if (place.level >= skipped_)
      blobs.push_back({groundKey(place.level - skipped_, place.column, place.row), packGroundTile(tile)});
  }

 private:
  explicit Blocks(const GroundSources& sources) : sources_(sources) {}

  void setLevels(double texelsPerPost) {
    const PostGrid& posts = sources_.heights->posts();
    shape_ = makeGroundShape(posts, texelsPerPost);
    GroundShape fine = makeGroundShape(posts, std::max(texelsPerPost, 1.0));
    levels_ = fine.levels;
    skipped_ = static_cast<std::uint32_t>(std::lround(std::log2(fine.texelsPerPost / texelsPerPost)));
    while (levels_.size() < skipped_ + shape_.levels.size())
      levels_.push_back({(levels_.back().columns + 1) / 2, (levels_.back().rows + 1) / 2});
    blockLevel_ = std::min(kBlockLevel, static_cast<std::uint32_t>(levels_.size()) - 1);
    texelsPerPost_ = fine.texelsPerPost;
    fine.levels = levels_;
    paint_ = std::make_unique<GroundPaint>(posts, fine, kTile << blockLevel_);
  }

  void gather(const Place& place, std::vector<Place>& blocks) const {
    if (place.level == blockLevel_) {
      blocks.push_back(place);
      return;
    }
    for (const Place& child : tilesBelow(levels_, place)) gather(child, blocks);
  }

  /// RGBA of a block's texels of level 0, which of them images gave, and what was painted.
  struct Colours {
    GroundWindow window;
    std::vector<GroundTriangle> triangles;
    std::vector<std::uint8_t> rgba;     ///< empty: none
    std::vector<std::uint8_t> byImage;  ///< a byte a texel; empty: none
  };

  Result<Colours> coloursOf(const Place& block) const {
    const std::uint32_t side = kTile << block.level;
    Colours colours;
    GroundWindow& w = colours.window;
    w = {block.column * side, block.row * side, 0, 0};
    w.columns = std::min(side, levels_[0].columns - w.column);
    w.rows = std::min(side, levels_[0].rows - w.row);
    const std::size_t texels = std::size_t{w.columns} * w.rows;
    if (sources_.triangles != nullptr) {
      auto found = sources_.triangles->over(paint_->degreesOf(block.column, block.row));
      if (!found) return found.findings();
      colours.triangles = std::move(found).value();
      colours.rgba.resize(texels * 4);
      paint_->paint(colours.triangles, w, colours.rgba);
    }
    const PostGrid& posts = sources_.heights->posts();
    PostGrid places;
    places.stepLongitude = posts.stepLongitude / texelsPerPost_;
    places.stepLatitude = posts.stepLatitude / texelsPerPost_;
    places.west = posts.west + w.column * places.stepLongitude;
    places.south = posts.south + w.row * places.stepLatitude;
    places.columns = w.columns;
    places.rows = w.rows;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      if (!images_[i]->touches(places)) continue;
      auto read = images_[i]->read(places);
      if (!read) return read.findings();
      colours.rgba.resize(texels * 4);
      colours.byImage.resize(texels);
      std::uint64_t covered = 0, first = 0;
      for (std::size_t t = 0; t < texels; ++t) {
        const std::uint8_t* from = &(*read)[t * 4];
        if (from[3] == 0) continue;
        ++covered;
        if (colours.byImage[t] != 0) continue;
        colours.byImage[t] = 1;
        ++first;
        std::copy_n(from, 4, &colours.rgba[t * 4]);
      }
      covered_[i] += covered;
      coveredByAny_ += first;
    }
    return colours;
  }

  Result<GroundTile> tile(const Place& place, const Place& block, const Colours& colours,
                          std::vector<Blob>& blobs) const {
    const GroundTileSize size = sizeOfGroundTile(levels_[place.level], place.column, place.row);
    if (place.level == 0) {
      std::span<const std::uint8_t> rgba;
      if (!colours.rgba.empty())
        rgba = std::span(colours.rgba)
                   .subspan((std::size_t{place.row * kTile - colours.window.row} * colours.window.columns +
                             (place.column * kTile - colours.window.column)) *
                            4);
      GroundTile made = groundTexels(*sources_.heights, *sources_.geometry, texelsPerPost_, place.column,
                                     place.row, size, rgba, colours.window.columns);
      keep(blobs, place, made);
      return made;
    }
    auto made =
        halvedFrom(levels_, place, [&](const Place& child) { return tile(child, block, colours, blobs); });
    if (!made) return made;
    if (sources_.triangles != nullptr) {
      paint_->paintLines(colours.triangles, place.level, place.column, place.row,
                         byImageOf(place, size, colours), *made);
      padGroundTile(*made, size);
    }
    keep(blobs, place, *made);
    return made;
  }

  /// Returns which texels of a coarser tile an image gave, and those past the border.
  static std::vector<std::uint8_t> byImageOf(const Place& place, GroundTileSize size,
                                             const Colours& colours) {
    std::vector<std::uint8_t> covered(std::size_t{kTile} * kTile, 1);
    for (std::uint32_t r = 0; r < size.rows; ++r)
      for (std::uint32_t c = 0; c < size.columns; ++c) {
        const std::uint32_t x = ((place.column * kTile + c) << place.level) - colours.window.column,
                            y = ((place.row * kTile + r) << place.level) - colours.window.row;
        covered[std::size_t{r} * kTile + c] =
            colours.byImage.empty() ? 0 : colours.byImage[std::size_t{y} * colours.window.columns + x];
      }
    return covered;
  }

  GroundSources sources_;
  GroundShape shape_;                       ///< as it is kept
  std::vector<GroundShape::Level> levels_;  ///< as they are made
  std::uint32_t skipped_ = 0, blockLevel_ = 0;
  double texelsPerPost_ = 1;  ///< as they are made
  std::vector<std::unique_ptr<GroundImage>> images_;
  std::unique_ptr<GroundPaint> paint_;
  mutable std::atomic<std::uint64_t> coveredByAny_{0};       ///< texels
  mutable std::vector<std::atomic<std::uint64_t>> covered_;  ///< texels, by image
};

/// Takes blocks in their order and makes every tile above whose last child has come.
class Top {
 public:
  Top(const Blocks& blocks, AddBlob add) : blocks_(blocks), add_(std::move(add)) {}

  Result<Done> take(const Place& place, Blocks::Built built) {
    for (const Blob& blob : built.blobs)
      if (auto done = add_(blob.key, blob.bytes); !done) return done;
    return take(place, std::move(built.top));
  }

 private:
  Result<Done> take(const Place& place, GroundTile tile) {
    const auto& levels = blocks_.levels();
    if (place.level + 1 == levels.size()) return Done{};
    const Place parent{place.level + 1, place.column / 2, place.row / 2};
    auto& waiting = waiting_[groundKey(parent.level, parent.column, parent.row)];
    waiting[groundKey(place.level, place.column, place.row)] = std::move(tile);
    if (waiting.size() < tilesBelow(levels, parent).size()) return Done{};
    auto made = halvedFrom(levels, parent, [&](const Place& child) -> Result<GroundTile> {
      return std::move(waiting.at(groundKey(child.level, child.column, child.row)));
    });
    waiting_.erase(groundKey(parent.level, parent.column, parent.row));
    if (!made) return made.findings();
    std::vector<Blob> blobs;
    blocks_.keep(blobs, parent, *made);
    for (const Blob& blob : blobs)
      if (auto done = add_(blob.key, blob.bytes); !done) return done;
    return take(parent, std::move(made).value());
  }

  const Blocks& blocks_;
  AddBlob add_;
  std::map<std::uint64_t, std::map<std::uint64_t, GroundTile>> waiting_;
};

/// Blocks of a share on all cores, into `add` in their order. No more are begun ahead of the first that is
/// not done than `memory` and two a core allow.
Result<Done> buildBlocks(const Blocks& blocks, std::span<const Place> places, std::size_t memory,
                         const AddBlob& add, const Progress& progress) {
  Top top(blocks, add);
  const std::size_t ahead = std::clamp<std::size_t>(memory / kBytesABlock, 1,
                                                    2 * std::max(1u, std::thread::hardware_concurrency()));
  std::mutex mutex;
  std::condition_variable moved;
  std::map<std::uint32_t, Blocks::Built> done;
  std::uint32_t next = 0;
  Findings failed;
  std::atomic<bool> stop{false};
  const auto end = [&] {
    stop = true;
    moved.notify_all();
  };
  const auto make = [&](std::uint32_t i, const GoesOn& goesOn) {
    std::unique_lock lock(mutex);
    // Blocks are begun in their order: whoever has the first of them does not wait.
    while (!moved.wait_for(lock, std::chrono::milliseconds(50), [&] { return stop || i < next + ahead; })) {
      lock.unlock();
      goesOn();
      lock.lock();
    }
    if (stop) return;
    lock.unlock();
    auto built = blocks.build(places[i]);
    lock.lock();
    if (!built) {
      failed.insert(failed.end(), built.findings().begin(), built.findings().end());
      end();
      return;
    }
    done.emplace(i, std::move(built).value());
    for (auto at = done.find(next); at != done.end() && !stop; at = done.find(++next)) {
      if (auto taken = top.take(places[next], std::move(at->second)); !taken) {
        failed.insert(failed.end(), taken.findings().begin(), taken.findings().end());
        stop = true;
      }
      done.erase(at);
    }
    moved.notify_all();
  };
  const auto work = [&](std::uint32_t i, const GoesOn& goesOn) {
    try {
      make(i, goesOn);
    } catch (...) {
      const std::lock_guard lock(mutex);
      end();
      throw;
    }
  };
  const auto carryOn = [&](double share) {
    if (!stop && (!progress || progress(share, "the ground's colours"))) return true;
    const std::lock_guard lock(mutex);
    end();
    return false;
  };
  const bool whole = forEachParallel(static_cast<std::uint32_t>(places.size()), work, carryOn);
  if (!failed.empty()) return failed;
  if (!whole) return cancelled("the ground's colours");
  return Done{};
}

}  // namespace

Findings aboutCover(std::span<const fs::path> images, const GroundCover& cover) {
  Findings notes;
  if (images.empty()) return notes;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (cover.covered[i] == 0)
      notes.push_back({cover.coveredByAny == 0 ? Severity::error : Severity::note, images[i].string(),
                       "georeference", "an image over the terrain", "none of its ground covered"});
  const std::uint64_t without = cover.texels - cover.coveredByAny, percent = 100 * without / cover.texels;
  if (without > 0 && cover.coveredByAny > 0)
    notes.push_back({Severity::note,
                     images.size() == 1 ? images[0].string() : std::to_string(images.size()) + " images",
                     "georeference", "an image over the whole terrain",
                     (percent == 0 ? "less than 1" : std::to_string(percent)) + " % of it without"});
  return notes;
}

Result<GroundCover> buildGroundPart(const GroundSources& sources, std::uint32_t part, std::uint32_t parts,
                                    const fs::path& file, const Progress& progress) {
  auto blocks = Blocks::make(sources);
  if (!blocks) return blocks.findings();
  Findings notes = blocks.findings();
  auto writer = PageFileWriter::create(file);
  if (!writer) return writer.findings();
  const AddBlob add = [&](std::uint64_t key, std::span<const std::byte> blob) {
    return (*writer)->add(key, blob);
  };
  if (auto done = add(kGroundShapeKey, packGroundShape((*blocks)->shape())); !done) return done.findings();
  const std::vector<Place> all = (*blocks)->all();
  const auto bound = [&](std::uint32_t i) { return (*blocks)->boundary(all, all.size() * i / parts); };
  if (auto done = buildBlocks(**blocks, std::span(all).subspan(bound(part), bound(part + 1) - bound(part)),
                              sources.memory, add, progress);
      !done)
    return done.findings();
  GroundCover cover = (*blocks)->cover();
  if (parts == 1) {
    const Findings about = aboutCover(sources.images, cover);
    notes.insert(notes.end(), about.begin(), about.end());
    for (const Finding& finding : about)
      if (finding.severity == Severity::error) return notes;
  }
  if (sources.heights->failed()) return unreadable("heights");
  if (auto done = (*writer)->finish(); !done) return done.findings();
  return Result<GroundCover>(std::move(cover), std::move(notes));
}

Result<Done> buildGround(const GroundSources& sources, const fs::path& file, const Progress& progress) {
  const auto made = buildGroundPart(sources, 0, 1, file, progress);
  if (!made) return made.findings();
  return Result<Done>(Done{}, made.findings());
}

}  // namespace trimtab::terrain
