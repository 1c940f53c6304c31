#include "heights.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <sstream>

#include "trimtab/terrain/format/checked_rows.h"
#include "trimtab/terrain/format/post_sources.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/file_at.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/grid/voids.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

Finding wrong(const fs::path& where, std::string expected, int error) {
  return {Severity::error, where.string(), "", std::move(expected),
          error != 0 ? std::strerror(error) : "the file's end"};
}

/// A file of rows of equal size, for reading and writing.
class RowFile {
 public:
  RowFile(fs::path file, std::size_t rowBytes, int flags)
      : path_(std::move(file)),
        rowBytes_(rowBytes),
        handle_(::open(path_.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~RowFile() {
    if (handle_ >= 0) ::close(handle_);
  }
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  const fs::path& path() const { return path_; }
  bool isOpen() const { return handle_ >= 0; }
  Result<Done> read(std::uint32_t first, std::uint32_t rows, void* data) const {
    if (!readAt(handle_, first * std::uint64_t{rowBytes_}, data, rows * rowBytes_))
      return wrong(path_, "rows that can be read", errno);
    return Done{};
  }
  Result<Done> write(std::uint32_t first, std::uint32_t rows, const void* data) const {
    if (!writeAt(handle_, first * std::uint64_t{rowBytes_}, data, rows * rowBytes_))
      return wrong(path_, "room to write " + std::to_string(rows * rowBytes_) + " bytes", errno);
    return Done{};
  }

 private:
  fs::path path_;
  std::size_t rowBytes_;
  int handle_;
};

std::string bits(double value) {
  return hexadecimal(std::bit_cast<std::uint64_t>(value));
}
std::string describe(const PostGrid& posts) {
  return "posts " + bits(posts.west) + " " + bits(posts.south) + " " + bits(posts.stepLongitude) + " " +
         bits(posts.stepLatitude) + " " + std::to_string(posts.columns) + " " + std::to_string(posts.rows);
}
/// Reads what follows "posts" in such a line.
PostGrid postsOf(std::istream& words) {
  PostGrid posts;
  for (double* value : {&posts.west, &posts.south, &posts.stepLongitude, &posts.stepLatitude}) {
    std::uint64_t there = 0;
    words >> std::hex >> there;
    *value = std::bit_cast<double>(there);
  }
  words >> std::dec >> posts.columns >> posts.rows;
  return posts;
}
std::uint64_t sumOf(const void* data, std::size_t size) {
  return checksum({static_cast<const char*>(data), size});
}

class HeightsBake {
 public:
  HeightsBake(const WorkFolder& work, ElevationSource& source, std::size_t memory, const Progress& progress)
      : work_(work),
        source_(source),
        progress_(progress),
        posts_(source.posts()),
        memory_(memory),
        rowBytes_(std::size_t{posts_.columns} * sizeof(float)),
        bitBytes_((posts_.columns + 7) / 8),
        bandRows_(static_cast<std::uint32_t>(
            std::clamp<std::size_t>(memory / 16 / std::max<std::size_t>(1, rowBytes_), 1, posts_.rows))),
        heights_(work.database() / kHeightsName, rowBytes_, O_RDWR | O_CREAT),
        voids_(work.path() / kVoidsName, bitBytes_, O_RDWR | O_CREAT) {
    band_.resize(std::size_t{bandRows_} * posts_.columns);
    bandBits_.resize(bandRows_ * bitBytes_);
    if (source.names().empty()) return;
    sources_.emplace(work_.path() / kPostSourcesName, sourceBytes(), O_RDWR | O_CREAT);
    bandSources_.resize(band_.size());
  }

  Result<BakedHeights> run() {
    if (!heights_.isOpen()) return wrong(heights_.path(), "a file that can be written", errno);
    if (!voids_.isOpen()) return wrong(voids_.path(), "a file that can be written", errno);
    if (sources_ && !sources_->isOpen()) return wrong(sources_->path(), "a file that can be written", errno);
    baked_.posts = posts_;
    readJournal();
    if (done_ && isAsNoted()) return baked_;
    // Not all that was written is on the disk after a power cut: only bands that agree with their sums stay.
    if (auto read = readBands(); !read) return read.findings();
    if (auto filled = fill(); !filled) return filled.findings();
    if (auto summed = sumUp(); !summed) return summed.findings();
    return baked_;
  }

 private:
  Result<Done> tell(double share, const char* what) const {
    if (progress_ && !progress_(share, what)) return cancelled(what);
    return Done{};
  }

  /// Reads what an earlier bake of the same grid did, as far as the file agrees.
  void readJournal() {
    const std::string posts = describe(posts_);
    bool ours = false;
    for (const std::string& line : work_.journal()) {
      std::istringstream words(line);
      std::string word, sum;
      words >> word;
      if (word == "posts") ours = line == posts;
      if (!ours) continue;
      noted_ = true;
      if (word == "posts") {
        next_ = 0;
        bands_.clear();
        done_ = false;
      } else if (word == "band") {
        std::uint32_t first = 0, rows = 0;
        std::uint64_t voids = 0, outside = 0;
        words >> first >> rows >> sum >> voids >> outside;
        // Read again from here on, perhaps in bands of another size.
        while (!bands_.empty() && bands_.back().first >= first) {
          next_ = bands_.back().first;
          bands_.pop_back();
        }
        if (first != next_) continue;
        bands_.push_back({first, rows, voids, outside, sum, {}});
        for (std::uint64_t given = 0; words >> given;) bands_.back().given.push_back(given);
        next_ = first + rows;
      } else if (word == "heights") {
        words >> sum;
        doneSum_ = sum;
        done_ = true;
      }
    }
    for (const Band& band : bands_) count(band);
  }

  struct Band {
    std::uint32_t first, rows;
    std::uint64_t voids, outside;
    std::string sum;
    std::vector<std::uint64_t> given;  ///< as ElevationSource tells it, of these rows
  };
  void count(const Band& band) {
    baked_.voids += band.voids;
    baked_.outside += band.outside;
    baked_.given.resize(std::max(baked_.given.size(), band.given.size()));
    for (std::size_t i = 0; i < band.given.size(); ++i) baked_.given[i] += band.given[i];
  }

  /// Voids that an interrupted filling has filled in part are voids again.
  Result<Done> readVoided(std::uint32_t first, std::uint32_t rows) {
    if (auto read = heights_.read(first, rows, band_.data()); !read) return read;
    if (auto read = voids_.read(first, rows, bandBits_.data()); !read) return read;
    if (sources_)
      if (auto read = sources_->read(first, rows, bandSources_.data()); !read) return read;
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t c = 0; c < posts_.columns; ++c)
        if (bandBits_[r * bitBytes_ + c / 8] >> (c % 8) & 1)
          band_[std::size_t{r} * posts_.columns + c] = std::numeric_limits<float>::quiet_NaN();
    return Done{};
  }

  Result<Done> readBands() {
    if (!noted_)
      if (auto noted = work_.note(describe(posts_)); !noted) return noted;
    // Bands that are as they were noted stay; what comes after the first that is not is read again.
    next_ = 0;
    baked_.voids = baked_.outside = 0;
    baked_.given.clear();
    for (const Band& band : bands_) {
      std::uint64_t bandSum = 0;
      for (std::uint32_t done = 0; done < band.rows;) {
        const std::uint32_t rows = std::min(bandRows_, band.rows - done);
        if (auto read = readVoided(band.first + done, rows); !read) {
          bandSum = 0;
          break;
        }
        // They may have been filled in part.
        if (band.voids + band.outside > 0)
          if (auto put = heights_.write(band.first + done, rows, band_.data()); !put) return put;
        bandSum = rowsSum(rows, bandSum);
        done += rows;
      }
      if (band.first != next_ || hexadecimal(bandSum) != band.sum) break;
      next_ += band.rows;
      count(band);
    }
    std::vector<std::uint8_t> beyond(band_.size());
    while (next_ < posts_.rows) {
      if (auto told = tell(0.8 * next_ / posts_.rows, "reading heights"); !told) return told;
      const std::uint32_t rows = std::min(bandRows_, posts_.rows - next_);
      const std::size_t posts = std::size_t{rows} * posts_.columns;
      std::fill(beyond.begin(), beyond.end(), std::uint8_t{0});
      const std::span<float> band = std::span(band_).first(posts);
      const std::vector<std::uint64_t> givenBefore = source_.given();
      const auto from = std::span(bandSources_).first(sources_ ? posts : 0);
      if (auto read = source_.readRows(next_, rows, band, std::span(beyond).first(posts), from); !read)
        return read;
      std::fill(bandBits_.begin(), bandBits_.end(), std::uint8_t{0});
      std::uint64_t voids = 0, outside = 0;
      for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < posts_.columns; ++c) {
          const std::size_t at = std::size_t{r} * posts_.columns + c;
          if (std::isfinite(band[at])) continue;
          band[at] = std::numeric_limits<float>::quiet_NaN();
          bandBits_[r * bitBytes_ + c / 8] |= static_cast<std::uint8_t>(1 << (c % 8));
          ++(beyond[at] ? outside : voids);
        }
      if (auto put = heights_.write(next_, rows, band_.data()); !put) return put;
      if (auto put = voids_.write(next_, rows, bandBits_.data()); !put) return put;
      if (sources_)
        if (auto put = sources_->write(next_, rows, bandSources_.data()); !put) return put;
      Band made{next_, rows, voids, outside, hexadecimal(rowsSum(rows)), source_.given()};
      for (std::size_t i = 0; i < givenBefore.size(); ++i) made.given[i] -= givenBefore[i];
      std::ostringstream line;
      line << "band " << made.first << ' ' << made.rows << ' ' << made.sum << ' ' << voids << ' ' << outside;
      for (const std::uint64_t given : made.given) line << ' ' << given;
      if (auto noted = work_.note(line.str()); !noted) return noted;
      next_ += rows;
      count(made);
    }
    return Done{};
  }

  /// Sums the current band row by row, so that the sum does not depend on how many rows are looked at
  /// together.
  std::uint64_t rowsSum(std::uint32_t rows, std::uint64_t sum = 0) const {
    for (std::uint32_t r = 0; r < rows; ++r) {
      sum = std::rotl(sum, 1) ^ sumOf(&band_[std::size_t{r} * posts_.columns], rowBytes_);
      if (sources_)
        sum = std::rotl(sum, 1) ^ sumOf(&bandSources_[std::size_t{r} * posts_.columns], sourceBytes());
    }
    return sum;
  }
  std::size_t sourceBytes() const { return std::size_t{posts_.columns} * sizeof(std::uint16_t); }

  Result<Done> fill() {
    if (baked_.voids + baked_.outside == 0) return Done{};
    VoidFill voids;
    voids.columns = posts_.columns;
    voids.rows = posts_.rows;
    voids.read = [&](std::uint32_t first, std::uint32_t rows, std::span<float> out) {
      return heights_.read(first, rows, out.data());
    };
    voids.write = [&](std::uint32_t first, std::uint32_t rows, std::span<const float> in) {
      return heights_.write(first, rows, in.data());
    };
    voids.scratch = work_.path();
    voids.memory = memory_ / 4;
    voids.carryOn = [&](double share) {
      return !progress_ || progress_(0.8 + 0.15 * share, "filling voids");
    };
    if (auto filled = fillVoids(voids); !filled) return filled.findings();
    return Done{};
  }

  /// Returns the sums of the finished rows, and finds the lowest and highest.
  Result<std::vector<std::uint64_t>> sums() {
    CheckedRows::Sums all(rowBytes_);
    baked_.lowest = std::numeric_limits<float>::infinity();
    baked_.highest = -baked_.lowest;
    for (std::uint32_t first = 0; first < posts_.rows; first += bandRows_) {
      if (auto told = tell(0.95 + 0.05 * first / posts_.rows, "checking heights"); !told)
        return told.findings();
      const std::uint32_t rows = std::min(bandRows_, posts_.rows - first);
      if (auto read = heights_.read(first, rows, band_.data()); !read) return read.findings();
      const auto band = std::span<const float>(band_).first(std::size_t{rows} * posts_.columns);
      for (const float h : band)
        baked_.lowest = std::min(baked_.lowest, h), baked_.highest = std::max(baked_.highest, h);
      all.add(std::as_bytes(band));
    }
    return all.finish();
  }

  Result<Done> sumUp() {
    auto all = sums();
    if (!all) return all.findings();
    const auto file =
        writeFile(work_.database(), kHeightSumsName,
                  {reinterpret_cast<const char*>(all->data()), all->size() * sizeof(std::uint64_t)});
    if (!file) return file.findings();
    baked_.sum = *file->sum;
    return work_.note("heights " + hexadecimal(baked_.sum));
  }

  bool isAsNoted() {
    const auto all = sums();
    if (!all) return false;
    baked_.sum = sumOf(all->data(), all->size() * sizeof(std::uint64_t));
    return hexadecimal(baked_.sum) == doneSum_ &&
           bool(writeFile(work_.database(), kHeightSumsName,
                          {reinterpret_cast<const char*>(all->data()), all->size() * sizeof(std::uint64_t)}));
  }

  const WorkFolder& work_;
  ElevationSource& source_;
  const Progress& progress_;
  PostGrid posts_;
  std::size_t memory_, rowBytes_, bitBytes_;
  std::uint32_t bandRows_;
  RowFile heights_, voids_;
  std::optional<RowFile> sources_;  ///< empty if the sources have no names
  std::vector<std::uint16_t> bandSources_;
  std::vector<float> band_;
  std::vector<std::uint8_t> bandBits_;
  BakedHeights baked_;
  std::vector<Band> bands_;
  std::uint32_t next_ = 0;
  bool noted_ = false, done_ = false;
  std::string doneSum_;
};

class GridSource final : public ElevationSource {
 public:
  explicit GridSource(const HeightGrid& grid) : grid_(grid) {}
  const PostGrid& posts() const override { return grid_.posts; }
  Result<Done> readRows(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                        std::span<std::uint8_t>, std::span<std::uint16_t> from) override {
    std::fill(from.begin(), from.end(), kNoSource);
    std::copy_n(grid_.heights.begin() + static_cast<std::ptrdiff_t>(std::size_t{first} * grid_.posts.columns),
                std::size_t{rows} * grid_.posts.columns, heights.begin());
    return Done{};
  }
  std::vector<std::string> names() const override { return {}; }
  std::vector<std::uint64_t> given() const override { return {}; }

 private:
  const HeightGrid& grid_;
};

}  // namespace

Result<BakedHeights> bakeHeights(const WorkFolder& work, ElevationSource& source, std::size_t memory,
                                 const Progress& progress) {
  return HeightsBake(work, source, memory, progress).run();
}

Result<std::optional<FileEntry>> bakeSources(const WorkFolder& work, const PostGrid& posts,
                                             const std::vector<std::string>& names) {
  if (names.empty()) return std::optional<FileEntry>();
  std::vector<std::uint16_t> row(posts.columns);
  const RowFile rows(work.path() / kPostSourcesName, row.size() * sizeof row[0], O_RDONLY);
  PostSources sources(names);
  for (std::uint32_t r = 0; r < posts.rows; ++r) {
    if (auto read = rows.read(r, 1, row.data()); !read) return read.findings();
    sources.addRow(row);
  }
  auto file = writeFile(work.database(), kSourcesName, sources.encoded());
  if (!file) return file.findings();
  return std::optional(std::move(file).value());
}

std::string inWords(const PostGrid& posts) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%u x %u posts from latitude %.9g, longitude %.9g, every %.9g x %.9g degrees", posts.columns,
                posts.rows, posts.south, posts.west, posts.stepLongitude, posts.stepLatitude);
  return text.data();
}

std::string workForOtherPosts(const WorkFolder& work, const PostGrid& posts) {
  const std::string ours = describe(posts);
  std::string others;
  bool other = false;
  for (const std::string& line : work.journal()) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    unsigned part = 0, parts = 0;
    if (word == "posts") {
      other = line != ours;
      if (other) others += (others.empty() ? "" : "; ") + inWords(postsOf(words));
    } else if (other && std::sscanf(line.c_str(), "ground ground-%u-of-%u", &part, &parts) == 2) {
      others += ", part " + std::to_string(part) + " of " + std::to_string(parts);
    }
  }
  return others;
}

std::unique_ptr<ElevationSource> sourceOf(const HeightGrid& grid) {
  return std::make_unique<GridSource>(grid);
}

}  // namespace trimtab::terrain
