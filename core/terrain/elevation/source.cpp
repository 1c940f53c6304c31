#include "trimtab/terrain/elevation/source.h"

#include <cpl_string.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <list>
#include <numeric>
#include <set>

#include "choose.h"
#include "file.h"
#include "merge.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

using Files = std::vector<std::unique_ptr<ElevationFile>>;

constexpr double kMostPosts = 4e9, kLongestSide = 500'000;
/// More files than systems let a program have open are opened again when they are needed.
constexpr std::size_t kMostOpen = 128;
/// Read out of order, a chunk needs its neighbours; three would do for rows in order.
constexpr std::size_t kChunksHeld = 4;

/// Columns beyond a grid round the earth: as far as a border is felt.
constexpr std::uint32_t kMargin = kGiveWay + 1;

/// Steps within 1 % are alike.
long fineness(const ElevationFile& file) {
  return std::lround(100 * std::log(file.posts().stepLatitude));
}

/// Longitudes of all files, degrees; more than a turn of them where one goes on beyond the ends of another
/// that goes all round.
std::pair<double, double> westAndEast(const Files& files) {
  double west = 1e9, east = -1e9;
  for (const auto& file : files) {
    const PostGrid& p = file->posts();
    west = std::min(west, p.west), east = std::max(east, p.longitude(p.columns - 1));
  }
  return {west, east};
}
bool isMoreThanATurn(const std::pair<double, double>& westAndEast) {
  return westAndEast.second - westAndEast.first > 360 + 1e-6;
}

/// Turns all files to one side of the earth: what is west of the widest gap between them continues after it.
void turnTogether(Files& files) {
  // One that goes all round stays as it is, and so does the first where none does.
  const auto round = std::find_if(files.begin(), files.end(), [](const auto& file) {
    return file->posts().columns * file->posts().stepLongitude > 360 - 1e-6;
  });
  const std::size_t stays = round == files.end() ? 0 : static_cast<std::size_t>(round - files.begin());
  const double first = files[stays]->posts().west;
  std::vector<std::pair<double, double>> spans;
  for (const auto& file : files) {
    const double west = std::remainder(file->posts().west - first, 360.0);
    spans.emplace_back(west < 0 ? west + 360 : west,
                       (file->posts().columns - 1) * file->posts().stepLongitude);
  }
  std::vector<std::pair<double, double>> sorted = spans;
  std::sort(sorted.begin(), sorted.end());
  double reached = sorted.front().first, gap = -1, start = 0;
  for (const auto& [west, width] : sorted) {
    if (west - reached > gap && west > reached) gap = west - reached, start = west;
    reached = std::max(reached, west + width);
  }
  if (sorted.front().first + 360 - reached >= gap) start = sorted.front().first;
  const double turned = spans[stays].first < start ? 360 : 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const double west = spans[i].first + (spans[i].first < start ? 360 : 0) - turned;
    files[i]->turn(360 * std::round((first + west - files[i]->posts().west) / 360));
  }
}

/// A step and a place for one axis of the grid.
struct Lattice {
  double step = 0, from = 0;
};

/// Uses the lattice of the finest file, or of a geographic one that is about as fine, so that its posts stay
/// as they are.
template <class Step, class From>
Lattice latticeOf(const Files& files, Step step, From from) {
  const ElevationFile* finest = nullptr;
  const ElevationFile* direct = nullptr;
  for (const auto& file : files) {
    if (finest == nullptr || step(file->posts()) < step(finest->posts()) * (1 - 1e-9)) finest = file.get();
    if (file->isDirect() && (direct == nullptr || step(file->posts()) < step(direct->posts()) * (1 - 1e-9)))
      direct = file.get();
  }
  if (direct != nullptr && step(direct->posts()) <= 1.1 * step(finest->posts())) finest = direct;
  return {step(finest->posts()), from(finest->posts())};
}

/// Returns the first post of the lattice that is not before `low`, and the last that is not beyond `high`.
std::pair<double, double> fit(Lattice& lattice, double low, double high) {
  const double first = std::ceil((low - lattice.from) / lattice.step - 1e-3);
  lattice.from += first * lattice.step;
  return {lattice.from, std::floor((high - lattice.from) / lattice.step + 1e-3) + 1};
}

Result<PostGrid> gridOf(const Files& files, const ElevationOptions& options) {
  if (files.size() == 1 && !options.stepLatitude) return files.front()->posts();
  Lattice across = latticeOf(
      files, [](const PostGrid& p) { return p.stepLongitude; }, [](const PostGrid& p) { return p.west; });
  Lattice up = latticeOf(
      files, [](const PostGrid& p) { return p.stepLatitude; }, [](const PostGrid& p) { return p.south; });
  if (options.stepLatitude) {
    across.step *= *options.stepLatitude / up.step;
    up.step = *options.stepLatitude;
  }
  const auto wide = westAndEast(files);
  const double west = wide.first, east = isMoreThanATurn(wide) ? west + 360 : wide.second;
  double south = 1e9, north = -1e9;
  for (const auto& file : files) {
    const PostGrid& p = file->posts();
    south = std::min(south, p.south), north = std::max(north, p.latitude(p.rows - 1));
  }
  PostGrid grid;
  const auto [left, columns] = fit(across, west, east);
  const auto [low, rows] = fit(up, south, north);
  if (!(columns * rows <= kMostPosts) || std::max(columns, rows) > kLongestSide || columns < 2 || rows < 2)
    return Finding{Severity::error, "all files together", "size",
                   "2 x 2 to 4 thousand million posts at the finest spacing, at most half a million a side",
                   numberText(columns) + " x " + numberText(rows)};
  grid.west = left;
  grid.south = low;
  grid.stepLongitude = across.step;
  grid.stepLatitude = up.step;
  grid.columns = static_cast<std::uint32_t>(columns);
  grid.rows = static_cast<std::uint32_t>(rows);
  return upToPoles(grid);
}

/// Adds files that continue beyond a grid round the earth once more, turned, where they meet the grid's other
/// end. Returns how many columns are to be merged beyond either end, so that both give the same.
std::uint32_t turnRound(Files& files, const PostGrid& grid) {
  if (!isMoreThanATurn(westAndEast(files))) return 0;
  Files all;
  for (auto& file : files) {
    const PostGrid& p = file->posts();
    std::vector<std::unique_ptr<ElevationFile>> again;
    for (const double degrees : {-360.0, 360.0}) {
      const double west = p.west + degrees, east = p.longitude(p.columns - 1) + degrees;
      const double margin = kMargin * grid.stepLongitude + 2 * p.stepLongitude;
      if (east + margin > grid.west && west - margin < grid.longitude(grid.columns - 1))
        again.push_back(file->turned(degrees));
    }
    all.push_back(std::move(file));
    std::move(again.begin(), again.end(), std::back_inserter(all));
  }
  files = std::move(all);
  return kMargin;
}

class MergedElevation final : public ElevationSource {
 public:
  MergedElevation(Files files, const PostGrid& grid, std::uint32_t margin)
      : files_(std::move(files)),
        grid_(grid),
        wide_(grid),
        margin_(margin),
        counted_((grid.rows + kChunkRows - 1) / kChunkRows, false) {
    wide_.west -= margin * grid.stepLongitude;
    wide_.columns += 2 * margin;
    for (auto& file : files_) {
      near_.push_back(file->placeOn(wide_));
      // A file that was turned stands behind itself.
      if (named_.empty() || file->name() != names_.back()) names_.push_back(file->name());
      named_.push_back(names_.size() - 1);
    }
    given_.resize(names_.size(), 0);
  }

  const PostGrid& posts() const override { return grid_; }
  std::vector<std::uint64_t> given() const override { return given_; }
  std::vector<std::string> names() const override { return names_; }

  Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                        std::span<std::uint8_t> beyond, std::span<std::uint16_t> from) override {
    const std::size_t across = grid_.columns;
    for (std::uint32_t row = first; row < first + rows;) {
      const std::uint32_t index = row / kChunkRows, start = row % kChunkRows,
                          count = std::min(kChunkRows - start, first + rows - row);
      if (auto merged = merge(index); !merged) return merged;
      for (std::uint32_t r = 0; r < count; ++r) {
        const auto at = static_cast<std::ptrdiff_t>(std::size_t{row - first + r} * across),
                   in = static_cast<std::ptrdiff_t>(std::size_t{start + r} * wide_.columns + margin_),
                   n = static_cast<std::ptrdiff_t>(across);
        std::copy_n(merged_.begin() + in, n, heights.begin() + at);
        if (!beyond.empty())
          std::transform(
              reached_.begin() + in, reached_.begin() + in + n, beyond.begin() + at,
              [](std::uint8_t reached) { return reached == 0 ? std::uint8_t{1} : std::uint8_t{0}; });
        if (!from.empty())
          std::transform(from_.begin() + in, from_.begin() + in + n, from.begin() + at,
                         [&](std::uint32_t file) { return sourceOf(file); });
      }
      row += count;
      // The count includes the last row, so that whoever goes on within a chunk counts it as one who began
      // with it does.
      if (row % kChunkRows == 0 || row == grid_.rows) countGiven(index);
    }
    return Done{};
  }

 private:
  struct Held {
    std::uint32_t index;
    ElevationChunk chunk;
  };

  /// Chunk `index` as it will be given out.
  Result<Done> merge(std::uint32_t index) {
    if (index == at_) return Done{};
    const auto chunks = static_cast<std::uint32_t>(counted_.size());
    for (const std::uint32_t k : {index, index - 1, index + 1}) {
      if (k >= chunks) continue;
      if (auto read = hold(k); !read) return read;
    }
    merged_.resize(std::size_t{kChunkRows} * wide_.columns);
    from_.resize(merged_.size());
    const ElevationChunk& chunk = *find(index);
    mergeChunk(index > 0 ? find(index - 1) : nullptr, chunk, find(index + 1), merged_, from_);
    givenNow_.assign(files_.size(), 0);
    for (std::size_t i = 0; i < from_.size(); ++i)
      if (from_[i] != kNoFile && chunk.counts(i)) ++givenNow_[from_[i]];
    reached_ = chunk.reached;
    at_ = index;
    return Done{};
  }

  /// Names beyond the numbers that there are for them stay unknown.
  std::uint16_t sourceOf(std::uint32_t file) const {
    return file == kNoFile || named_[file] >= kNoSource ? kNoSource
                                                        : static_cast<std::uint16_t>(named_[file]);
  }

  void countGiven(std::uint32_t index) {
    if (counted_[index]) return;
    for (std::size_t i = 0; i < givenNow_.size(); ++i) given_[named_[i]] += givenNow_[i];
    counted_[index] = true;
  }

  const ElevationChunk* find(std::uint32_t index) {
    for (const Held& held : held_)
      if (held.index == index) return &held.chunk;
    return nullptr;
  }

  Result<Done> hold(std::uint32_t index) {
    for (auto held = held_.begin(); held != held_.end(); ++held)
      if (held->index == index) {
        held_.splice(held_.begin(), held_, held);
        return Done{};
      }
    Held held{index, {}};
    ElevationChunk& chunk = held.chunk;
    chunk.columns = wide_.columns;
    chunk.margin = margin_;
    chunk.reached.assign(std::size_t{kChunkRows} * wide_.columns, 0);
    const std::uint32_t first = index * kChunkRows, rows = std::min(kChunkRows, grid_.rows - first);
    for (std::size_t i = 0; i < files_.size(); ++i) {
      ElevationFile& file = *files_[i];
      if (!near_[i] || !file.reaches(first, rows)) continue;
      chunk.layers.push_back({i, named_[i], file.firstColumn(), file.columns(), {}, {}});
      ElevationLayer& layer = chunk.layers.back();
      layer.heights.resize(std::size_t{kChunkRows} * layer.columns);
      if (auto read = file.read(first, rows, layer.heights, chunk.reached, layer.continued, room_); !read)
        return read;
      keepOpen(i);
    }
    closeOthers(first, rows);
    chunk.count();
    if (held_.size() >= kChunksHeld) held_.pop_back();
    held_.push_front(std::move(held));
    return Done{};
  }

  /// The last that were read.
  void keepOpen(std::size_t file) {
    open_.remove(file);
    open_.push_front(file);
    if (open_.size() <= kMostOpen) return;
    files_[open_.back()]->close();
    open_.pop_back();
  }

  /// Rows are read from south to north: who has none of these will hardly be asked again, and an open file
  /// may hold megabytes.
  void closeOthers(std::uint32_t first, std::uint32_t rows) {
    open_.remove_if([&](std::size_t file) {
      if (files_[file]->reaches(first, rows)) return false;
      files_[file]->close();
      return true;
    });
  }

  Files files_;
  PostGrid grid_, wide_;  ///< wide: with the margin on either side
  std::uint32_t margin_ = 0;
  std::vector<bool> near_;
  std::vector<std::string> names_;
  std::vector<std::size_t> named_;               ///< a file's place among the names
  std::vector<std::uint64_t> given_, givenNow_;  ///< by name; by file, of the chunk in `merged_`
  std::vector<bool> counted_;                    ///< a chunk's part of `given_`
  ElevationFile::Room room_;
  std::list<Held> held_;
  std::list<std::size_t> open_;
  std::vector<float> merged_;
  std::vector<std::uint32_t> from_;  ///< the file of each of these
  std::vector<std::uint8_t> reached_;
  std::uint32_t at_ = std::numeric_limits<std::uint32_t>::max();
};

}  // namespace

Result<std::unique_ptr<ElevationSource>> openElevation(std::span<const fs::path> sources,
                                                       const ElevationOptions& options) {
  const auto paths = elevationPaths(sources);
  if (!paths) return paths.findings();
  Findings findings = paths.findings();
  Files files;
  std::set<std::string> found;  // in folders
  bool failed = false, stopped = false;
  for (std::size_t i = 0; i < paths->size(); ++i) {
    const ElevationPath& path = (*paths)[i];
    const auto share = [&](double fraction, const std::string& what) {
      stopped =
          options.progress &&
          !options.progress((static_cast<double>(i) + fraction) / static_cast<double>(paths->size()), what);
      return !stopped;
    };
    auto file = ElevationFile::open(path.file, options.reading, share);
    for (Finding finding : file.findings()) {
      // A broken file of a folder does not stop the others.
      if (!path.named && !stopped && finding.severity == Severity::error)
        finding.severity = Severity::warning, finding.found += "; left out";
      findings.push_back(std::move(finding));
    }
    if (stopped) return findings;
    if (!path.named && path.weighed) found.insert(path.file.string());
    if (file)
      files.push_back(std::move(file).value());
    else
      failed = failed || path.named;
  }
  if (failed) return findings;
  if (!files.empty()) {
    turnTogether(files);
    const auto goesOn = [&](double, const std::string& what) {
      return !options.progress || options.progress(1, what);
    };
    if (!chooseElevation(files, found, goesOn, findings)) {
      findings.push_back(cancelled("elevation"));
      return findings;
    }
  }
  if (files.empty()) {
    // Of several CDBs one has the ground, others what stands on it.
    findings.push_back(
        paths->empty()
            ? Finding{Severity::error, sources.empty() ? "elevation" : sources.front().string(), "elevation",
                      "a CDB that has some (Tiles/.../001_Elevation)", "none: name one that has it too"}
            : Finding{Severity::error, "elevation", "", "a file with heights",
                      "none of " + std::to_string(paths->size()) + " rasters"});
    return findings;
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return fineness(*a) < fineness(*b); });
  const auto grid = gridOf(files, options);
  if (!grid) return grid.findings();
  const std::uint32_t margin = turnRound(files, *grid);
  return Result<std::unique_ptr<ElevationSource>>(
      std::make_unique<MergedElevation>(std::move(files), *grid, margin), std::move(findings));
}

Findings sharesOf(const std::vector<std::string>& names, const std::vector<std::uint64_t>& given) {
  constexpr std::size_t kMostTold = 24;
  std::uint64_t all = 0;
  for (const std::uint64_t posts : given) all += posts;
  Findings findings;
  if (all == 0 || names.size() < 2 || given.size() != names.size()) return findings;
  for (std::size_t i = 0; i < std::min(names.size(), kMostTold); ++i)
    findings.push_back({Severity::note, names[i], "share", "a part of the posts",
                        given[i] == 0
                            ? "none: others have the ground there"
                            : CPLSPrintf("%.1f %% of the heights",
                                         100.0 * static_cast<double>(given[i]) / static_cast<double>(all))});
  if (names.size() > kMostTold)
    findings.push_back(
        {Severity::note, "elevation", "share", "", std::to_string(names.size() - kMostTold) + " files more"});
  return findings;
}

}  // namespace trimtab::terrain
