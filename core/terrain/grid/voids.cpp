#include "trimtab/terrain/grid/voids.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/preset/unfinished.h"

namespace trimtab::terrain {

namespace {

/// Each level is relaxed so often: coarse levels know far neighbours, fine ones smooth.
constexpr std::uint32_t kSweeps = 12;
constexpr std::uint32_t kBand = 32;

using Row = std::vector<float>;

bool anyEmpty(std::span<const float> row) {
  return std::any_of(row.begin(), row.end(), [](float h) { return std::isnan(h); });
}

/// Rows of the pyramid's levels, in memory or in a file that has no name any more.
class Rows {
 public:
  Rows(std::size_t floats, std::size_t memory, std::filesystem::path folder) : folder_(std::move(folder)) {
    if (floats * sizeof(float) <= memory) {
      held_.resize(floats);
      return;
    }
    file_ = openUnnamed(folder_);
    failed_ = file_ < 0 ? errno : 0;
  }
  ~Rows() {
    if (file_ >= 0) ::close(file_);
  }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;

  void write(std::size_t first, std::span<const float> row) {
    if (file_ < 0 && failed_ == 0) {
      std::copy(row.begin(), row.end(), held_.begin() + static_cast<std::ptrdiff_t>(first));
      return;
    }
    const auto* bytes = reinterpret_cast<const char*>(row.data());
    for (std::size_t done = 0; done < row.size_bytes() && failed_ == 0;) {
      const ssize_t n = ::pwrite(file_, bytes + done, row.size_bytes() - done,
                                 static_cast<off_t>(first * sizeof(float) + done));
      if (n > 0)
        done += static_cast<std::size_t>(n);
      else if (n == 0 || errno != EINTR)
        failed_ = n == 0 ? ENOSPC : errno;
    }
  }
  void read(std::size_t first, std::span<float> row) {
    if (file_ < 0 && failed_ == 0) {
      std::copy_n(held_.begin() + static_cast<std::ptrdiff_t>(first), row.size(), row.begin());
      return;
    }
    auto* bytes = reinterpret_cast<char*>(row.data());
    for (std::size_t done = 0; done < row.size_bytes() && failed_ == 0;) {
      const ssize_t n = ::pread(file_, bytes + done, row.size_bytes() - done,
                                static_cast<off_t>(first * sizeof(float) + done));
      if (n > 0)
        done += static_cast<std::size_t>(n);
      else if (n == 0 || errno != EINTR)
        failed_ = n == 0 ? EIO : errno;
    }
  }
  std::optional<Finding> trouble() const {
    if (failed_ == 0) return {};
    return Finding{Severity::error, folder_.string(), "", "room for a file of heights while voids are filled",
                   std::strerror(failed_)};
  }

 private:
  std::filesystem::path folder_;
  std::vector<float> held_;
  int file_ = -1, failed_ = 0;
};

/// Describes a grid of half the size of the one before it, whose heights are means of those that are there.
struct Level {
  std::uint32_t columns = 0, rows = 0;
  std::size_t first = 0;  ///< where its rows are kept
  bool empty = false;     ///< something is still missing
  std::uint32_t next = 0;
  std::optional<Row> waiting;
};

class Pyramid {
 public:
  Pyramid(std::uint32_t columns, std::uint32_t rows, std::size_t memory,
          const std::filesystem::path& folder) {
    std::size_t floats = 0;
    levels_.push_back({columns, rows, 0, false, 0, {}});
    while (columns > 1 || rows > 1) {
      columns = (columns + 1) / 2, rows = (rows + 1) / 2;
      levels_.push_back({columns, rows, floats, false, 0, {}});
      floats += std::size_t{columns} * rows;
    }
    rows_.emplace(floats, memory, folder);
  }
  const Level& level(std::size_t l) const { return levels_[l]; }
  Rows& rows() { return *rows_; }
  /// Returns the first level that has a height everywhere.
  std::size_t whole() const {
    std::size_t l = 0;
    while (l + 1 < levels_.size() && levels_[l].empty) ++l;
    return l;
  }
  bool nothing() const { return levels_.back().empty; }

  void add(std::size_t l, std::span<const float> row) {
    Level& level = levels_[l];
    if (!level.empty) level.empty = anyEmpty(row);
    if (l > 0) rows_->write(level.first + std::size_t{level.next} * level.columns, row);
    const bool last = ++level.next == level.rows;
    if (l + 1 == levels_.size()) return;
    if (!level.waiting && !last) {
      level.waiting.emplace(row.begin(), row.end());
      return;
    }
    Row coarse(levels_[l + 1].columns);
    for (std::uint32_t c = 0; c < coarse.size(); ++c) {
      float sum = 0, count = 0;
      const auto take = [&](std::span<const float> from) {
        for (std::uint32_t x = 2 * c; x < std::min(2 * c + 2, level.columns); ++x)
          if (const float h = from[x]; !std::isnan(h)) sum += h, count += 1;
      };
      if (level.waiting) take(*level.waiting);
      take(row);
      coarse[c] = count > 0 ? sum / count : std::nanf("");
    }
    level.waiting.reset();
    add(l + 1, coarse);
  }

 private:
  std::vector<Level> levels_;
  std::optional<Rows> rows_;
};

/// A level's rows with their voids filled, in order. Sweeps of Gauss-Seidel follow each other a row apart:
/// sweep s is at row n - s when row n comes in, which is what sweeping the whole level s times gives, to the
/// bit, with 16 rows at hand.
class Filling {
 public:
  using Load = std::function<void(std::uint32_t row, std::span<float>)>;

  Filling(const Level& level, Load load, Filling* coarse)
      : columns_(level.columns), rows_(level.rows), load_(std::move(load)), coarse_(coarse) {
    for (Slot& slot : slots_) slot.heights.resize(columns_);
  }

  /// Row `row` or the one before the last that was asked for; never an earlier one.
  std::span<const float> row(std::uint32_t row) {
    while (next_ < row + 1 + (coarse_ ? kSweeps : 0) && next_ < rows_ + kSweeps) step();
    return slot(row).heights;
  }
  /// Reports whether the row had voids; good for the last that was asked for.
  bool hadVoids(std::uint32_t row) { return !slot(row).voids.empty(); }

 private:
  struct Slot {
    Row heights;
    std::vector<std::uint32_t> voids;
  };
  static constexpr std::uint32_t kSlots = 16;
  static_assert(kSlots >= kSweeps + 3);

  Slot& slot(std::uint32_t row) { return slots_[row % kSlots]; }

  void step() {
    const std::uint32_t n = next_++;
    if (n < rows_) {
      Slot& in = slot(n);
      load_(n, in.heights);
      in.voids.clear();
      if (coarse_ == nullptr) return;
      for (std::uint32_t c = 0; c < columns_; ++c)
        if (std::isnan(in.heights[c])) in.voids.push_back(c);
      fromCoarse(n, in);
    }
    if (coarse_ == nullptr) return;
    // The rows' chains of sums are independent but for a column's lag: taken a few columns at a time, one
    // after the other, they overlap in the processor. Twice as fast where voids are wide.
    std::array<Sweep, kSweeps> sweeps;
    std::size_t count = 0, voids = 0;
    for (std::uint32_t s = 1; s <= kSweeps && s <= n; ++s)
      if (n - s < rows_ && !slot(n - s).voids.empty()) {
        sweeps[count] = sweepOf(n - s);
        voids += sweeps[count++].voids.size();
      }
    const std::uint32_t stride = voids < columns_ ? columns_ : 4;
    for (std::uint32_t column = 0; voids > 0; column += std::min(stride, columns_ - column)) {
      const std::uint32_t end = column + std::min(stride, columns_ - column);
      for (std::size_t k = 0; k < count; ++k) relax(sweeps[k], end);
      if (end == columns_) break;
    }
  }

  void fromCoarse(std::uint32_t row, Slot& in) {
    const std::uint32_t rows = coarse_->rows_, columns = coarse_->columns_;
    const float y = std::clamp((static_cast<float>(row) - 0.5f) / 2, 0.0f, static_cast<float>(rows - 1));
    const auto r = static_cast<std::uint32_t>(y);
    const std::uint32_t r1 = std::min(r + 1, rows - 1);
    const float v = y - static_cast<float>(r);
    // The row is asked for even where nothing is missing: rows come in order.
    coarse_->row(r1);
    if (in.voids.empty()) return;
    const std::span<const float> low = coarse_->row(r), high = coarse_->row(r1);
    for (const std::uint32_t column : in.voids) {
      const float x =
          std::clamp((static_cast<float>(column) - 0.5f) / 2, 0.0f, static_cast<float>(columns - 1));
      const auto c = static_cast<std::uint32_t>(x);
      const std::uint32_t c1 = std::min(c + 1, columns - 1);
      const float u = x - static_cast<float>(c);
      in.heights[column] =
          (low[c] * (1 - u) + low[c1] * u) * (1 - v) + (high[c] * (1 - u) + high[c1] * u) * v;
    }
  }

  struct Sweep {
    std::span<const std::uint32_t> voids;
    float* here = nullptr;
    const float* below = nullptr;  ///< null at the first row
    const float* above = nullptr;  ///< null at the last
    std::size_t next = 0;
  };
  Sweep sweepOf(std::uint32_t row) {
    return {slot(row).voids, slot(row).heights.data(), row > 0 ? slot(row - 1).heights.data() : nullptr,
            row + 1 < rows_ ? slot(row + 1).heights.data() : nullptr, 0};
  }
  /// Voids to the mean of their neighbours, up to a column.
  void relax(Sweep& sweep, std::uint32_t end) const {
    float* const here = sweep.here;
    for (; sweep.next < sweep.voids.size() && sweep.voids[sweep.next] < end; ++sweep.next) {
      const std::uint32_t c = sweep.voids[sweep.next];
      if (sweep.below != nullptr && sweep.above != nullptr && c > 0 && c + 1 < columns_) {
        here[c] = (sweep.below[c] + sweep.above[c] + here[c - 1] + here[c + 1]) * 0.25f;
        continue;
      }
      float sum = 0, count = 0;
      const auto add = [&](float h) { sum += h, count += 1; };
      if (sweep.below != nullptr) add(sweep.below[c]);
      if (sweep.above != nullptr) add(sweep.above[c]);
      if (c > 0) add(here[c - 1]);
      if (c + 1 < columns_) add(here[c + 1]);
      if (count > 0) here[c] = sum / count;
    }
  }

  std::uint32_t columns_, rows_, next_ = 0;
  Load load_;
  Filling* coarse_;
  std::array<Slot, kSlots> slots_;
};

Finding stopped() {
  return {Severity::note, "filling voids", "", "to be completed", "cancelled"};
}

}  // namespace

Result<std::uint64_t> fillVoids(const VoidFill& fill) {
  const std::size_t across = fill.columns;
  if (across == 0 || fill.rows == 0) return std::uint64_t{0};
  Pyramid pyramid(fill.columns, fill.rows, fill.memory, fill.scratch);
  Row band(across * kBand);
  const auto rowsAt = [&](std::uint32_t first) { return std::min(kBand, fill.rows - first); };
  const auto carryOn = [&](double from, std::uint32_t row) {
    return !fill.carryOn || fill.carryOn(from + 0.5 * row / fill.rows);
  };

  std::uint64_t count = 0;
  for (std::uint32_t first = 0; first < fill.rows; first += kBand) {
    if (!carryOn(0, first)) return stopped();
    const std::span<float> rows(band.data(), rowsAt(first) * across);
    if (auto read = fill.read(first, rowsAt(first), rows); !read) return read.findings();
    for (std::uint32_t r = 0; r < rowsAt(first); ++r) {
      const std::span<const float> row(rows.subspan(r * across, across));
      count += static_cast<std::uint64_t>(
          std::count_if(row.begin(), row.end(), [](float h) { return std::isnan(h); }));
      pyramid.add(0, row);
    }
    if (auto trouble = pyramid.rows().trouble()) return *trouble;
  }
  if (count == 0) return count;

  Findings trouble;
  const auto fromBand = [&](std::uint32_t row, std::span<float> heights) {
    if (row % kBand == 0)
      if (auto read = fill.read(row, rowsAt(row), std::span(band.data(), rowsAt(row) * across)); !read)
        trouble = read.findings();
    std::copy_n(band.data() + (row % kBand) * across, across, heights.begin());
  };
  const std::size_t whole = pyramid.whole();
  std::vector<std::unique_ptr<Filling>> chain;
  if (!pyramid.nothing())
    for (std::size_t l = whole + 1; l-- > 0;) {
      const Level& level = pyramid.level(l);
      const auto fromLevel = [&pyramid, level](std::uint32_t row, std::span<float> heights) {
        pyramid.rows().read(level.first + std::size_t{row} * level.columns, heights);
      };
      chain.push_back(std::make_unique<Filling>(level,
                                                l == 0 ? Filling::Load(fromBand) : Filling::Load(fromLevel),
                                                chain.empty() ? nullptr : chain.back().get()));
    }
  const Row sea(across, 0.0f);
  for (std::uint32_t r = 0; r < fill.rows; ++r) {
    if (r % kBand == 0 && !carryOn(0.5, r)) return stopped();
    std::span<const float> row = sea;
    if (!chain.empty()) {
      row = chain.back()->row(r);
      if (!trouble.empty()) return trouble;
      if (auto lost = pyramid.rows().trouble()) return *lost;
      if (!chain.back()->hadVoids(r)) continue;
    }
    if (auto written = fill.write(r, 1, row); !written) return written.findings();
  }
  return count;
}

}  // namespace trimtab::terrain
