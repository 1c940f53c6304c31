#include "trimtab/terrain/scenery/blend.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/terrain/grid/grid_height.h"

namespace trimtab::terrain {

namespace {

/// A difference fades out over so many posts.
constexpr std::uint8_t kBandPosts = 32;
constexpr std::uint32_t kSweeps = 150;
constexpr double kOverRelaxation = 1.8;
/// So many posts are read together. For each band of rows all tiles that overlap it are searched.
constexpr std::size_t kTogether = std::size_t{1} << 19;

// Away from the nearest post of scenery, in posts, 0 on its border; or:
constexpr std::uint8_t kFar = kBandPosts + 1, kNotBlended = 255;
bool isElevations(std::uint8_t away) {
  return away != 0 && away != kNotBlended;
}

}  // namespace

double BlendedRows::elevationAt(std::uint32_t number, std::uint32_t column) const {
  const PostGrid& posts = scenery_.posts();
  return heightOf(
      elevation_->posts(), posts.longitude(column), posts.latitude(number),
      [&](std::uint32_t r, std::uint32_t c) { return elevationRows_[r - firstElevationRow_][c]; });
}

/// Reads the rows of elevation around a row of posts, and releases those south of the previous row.
Result<Done> BlendedRows::readElevation(std::uint32_t number) {
  const PostGrid& posts = elevation_->posts();
  const auto rowAt = [&](std::int64_t of) {
    const double latitude = scenery_.posts().latitude(static_cast<double>(of));
    return static_cast<std::int64_t>(std::floor((latitude - posts.south) / posts.stepLatitude));
  };
  constexpr std::uint32_t kRows = 64;
  const std::int64_t last = std::min<std::int64_t>(rowAt(number) + 2, std::int64_t{posts.rows} - 1),
                     first = rowAt(std::int64_t{number} - 1) - 1;
  while (!elevationRows_.empty() && firstElevationRow_ < first)
    elevationRows_.pop_front(), ++firstElevationRow_;
  // Rows that are not needed are not read.
  if (elevationRows_.empty())
    firstElevationRow_ = static_cast<std::uint32_t>(std::clamp<std::int64_t>(first, 0, posts.rows));
  while (firstElevationRow_ + std::int64_t(elevationRows_.size()) <= last) {
    const auto next = firstElevationRow_ + static_cast<std::uint32_t>(elevationRows_.size());
    const std::uint32_t rows = std::min(kRows, posts.rows - next);
    std::vector<float> heights(std::size_t{rows} * posts.columns);
    if (auto read = elevation_->readRows(next, rows, heights); !read) return read;
    for (std::uint32_t r = 0; r < rows; ++r) {
      const auto from = heights.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * posts.columns);
      elevationRows_.emplace_back(from, from + posts.columns);
    }
  }
  return Done{};
}

/// Reads some more rows of scenery, and fills their void posts from elevation.
Result<Done> BlendedRows::readScenery() {
  const PostGrid& posts = scenery_.posts();
  const std::size_t columns = posts.columns;
  const auto some = static_cast<std::uint32_t>(std::max<std::size_t>(kTogether / columns, kBandPosts));
  const std::uint32_t rows = std::min(some, posts.rows - read_);
  std::vector<float> heights(rows * columns);
  if (auto read = scenery_.read(read_, rows, heights); !read) return read;
  for (std::uint32_t r = 0; r < rows; ++r, ++read_) {
    if (auto read = readElevation(read_); !read) return read;
    Row& own = rows_.emplace_back();
    const auto from = heights.begin() + static_cast<std::ptrdiff_t>(r * columns);
    own.heights.assign(from, from + static_cast<std::ptrdiff_t>(columns));
    own.away.assign(columns, kNotBlended);
    own.reached.resize(columns);
    scenery_.reached(read_, own.reached);
    for (std::uint32_t c = 0; c < columns; ++c) {
      if (!std::isnan(own.heights[c])) continue;
      const double z = elevationAt(read_, c);
      if (std::isnan(z)) continue;
      own.heights[c] = static_cast<float>(z);
      own.away[c] = kFar;
      own.reached[c] = 1;
      own.difference.resize(columns);
    }
    if (read_ > 0) findBorder(read_ - 1);
  }
  if (read_ == posts.rows) findBorder(read_ - 1);
  return Done{};
}

/// Computes the difference between scenery and elevation where they meet. The next row must have been read.
void BlendedRows::findBorder(std::uint32_t number) {
  bordered_ = number + 1;
  Row& own = row(number);
  const Row *south = beside(number, -1), *north = beside(number, 1);
  const std::size_t columns = own.heights.size();
  const auto blends = [](const Row* of, std::size_t c) { return of && isElevations(of->away[c]); };
  for (std::uint32_t c = 0; c < columns; ++c) {
    if (own.away[c] != kNotBlended || std::isnan(own.heights[c])) continue;
    if (!((c > 0 && blends(&own, c - 1)) || (c + 1 < columns && blends(&own, c + 1)) || blends(south, c) ||
          blends(north, c)))
      continue;
    const double z = elevationAt(number, c);
    if (std::isnan(z)) continue;
    own.difference.resize(columns);
    own.difference[c] = own.heights[c] - static_cast<float>(z);
    own.away[c] = 0;
  }
}

/// Computes distances from the border in the rows that nothing farther north can be nearer to.
void BlendedRows::spread() {
  const std::uint32_t all = scenery_.posts().rows, columns = scenery_.posts().columns;
  const std::uint32_t end =
      bordered_ == all ? all : bordered_ - std::min<std::uint32_t>(bordered_, kBandPosts);
  if (end <= spread_) return;
  struct Post {
    std::uint32_t row, column;
  };
  std::array<std::vector<Post>, kFar> fronts;
  const std::uint32_t first = spread_ > 0 ? spread_ - 1 : 0;
  for (std::uint32_t r = first; r < bordered_; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      std::uint8_t& away = row(r).away[c];
      // These were set when less of the north was known.
      if (r >= spread_ && isElevations(away)) away = kFar;
      if (away < kFar) fronts[away].push_back({r, c});
    }
  for (std::uint8_t step = 1; step <= kBandPosts; ++step)
    for (const Post& post : fronts[step - 1u]) {
      const auto visit = [&](std::uint32_t r, std::uint32_t c) {
        if (r < spread_ || r >= bordered_ || c >= columns) return;
        std::uint8_t& away = row(r).away[c];
        if (away == kNotBlended || away <= step) return;
        away = step;
        fronts[step].push_back({r, c});
      };
      visit(post.row, post.column - 1);
      visit(post.row, post.column + 1);
      visit(post.row - 1, post.column);
      visit(post.row + 1, post.column);
    }
  for (; spread_ < end; ++spread_) {
    Row& own = row(spread_);
    for (std::uint32_t c = 0; c < columns; ++c)
      if (isElevations(own.away[c]) && own.away[c] < kFar) own.band.push_back(c);
  }
}

/// Smooths a row's band once.
void BlendedRows::relax(std::uint32_t number) {
  Row& own = row(number);
  if (own.band.empty()) return;
  const Row *south = beside(number, -1), *north = beside(number, 1);
  const std::size_t columns = own.heights.size();
  for (const std::uint32_t c : own.band) {
    double sum = 0;
    int count = 0;
    const auto add = [&](const Row* of, std::size_t column) {
      if (!of || column >= columns || of->away[column] == kNotBlended) return;
      sum += static_cast<double>(of->difference[column]);
      ++count;
    };
    add(&own, std::size_t{c} - 1);
    add(&own, std::size_t{c} + 1);
    add(south, c);
    add(north, c);
    if (count == 0) continue;
    const double was = static_cast<double>(own.difference[c]);
    own.difference[c] = static_cast<float>(was + kOverRelaxation * (sum / count - was));
  }
}

/// A sweep uses what it left in the row to the south, and what the previous sweep left in the row to the
/// north, as if the whole grid were swept row by row, again and again. So one row can have its first sweep
/// while the row before it has its second, and no more rows than sweeps are held in memory.
Result<Done> BlendedRows::advance() {
  const std::uint32_t all = scenery_.posts().rows;
  while (spread_ < all && spread_ <= relaxing_) {
    if (auto read = readScenery(); !read) return read;
    spread();
  }
  for (std::uint32_t sweep = 0; sweep < kSweeps && sweep <= relaxing_; ++sweep)
    if (relaxing_ - sweep < all) relax(relaxing_ - sweep);
  if (++relaxing_ < kSweeps) return Done{};
  Row& done = row(finished_++);
  for (const std::uint32_t c : done.band) done.heights[c] += done.difference[c];
  return Done{};
}

Result<Done> BlendedRows::read(std::uint32_t first, std::uint32_t rows, std::span<float> heights,
                               std::span<std::uint8_t> reached) {
  if (first < firstRow_) {
    elevationRows_.clear();
    rows_.clear();
    firstRow_ = read_ = bordered_ = spread_ = relaxing_ = finished_ = 0;
  }
  for (std::uint32_t number = first; number < first + rows; ++number) {
    while (finished_ <= number) {
      if (auto advanced = advance(); !advanced) return advanced;
      // The row before the unfinished ones is still needed by the first of them.
      while (firstRow_ + 1 < finished_ && firstRow_ < number) rows_.pop_front(), ++firstRow_;
    }
    const Row& own = row(number);
    const auto to = static_cast<std::ptrdiff_t>((number - first) * own.heights.size());
    std::copy(own.heights.begin(), own.heights.end(), heights.begin() + to);
    std::copy(own.reached.begin(), own.reached.end(), reached.begin() + to);
  }
  return Done{};
}

}  // namespace trimtab::terrain
