#include "sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace trimtab::terrain {

namespace {

constexpr double kVoid = std::numeric_limits<double>::quiet_NaN();

/// The post before, and what four posts weigh from the one before that.
struct Axis {
  std::int64_t post = 0;
  std::array<double, 4> weight{};
};

/// Returns false for what is not a number.
bool isWithinAPost(double x, std::int64_t count) {
  return x >= -1 && x <= static_cast<double>(count);
}

/// Returns the posts about a place on one axis and their weights.
Axis axisAt(double x, std::int64_t count) {
  Axis axis;
  axis.post = std::max(std::min(static_cast<std::int64_t>(std::floor(x)), count - 2), std::int64_t{0});
  const double t = x - static_cast<double>(axis.post);
  if (t < 0 || t > 1)
    axis.weight = {0, 1 - t, t, 0};
  else
    axis.weight = {((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1,
                   ((-1.5 * t + 2) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
  return axis;
}

/// Mixes four values by their weights; the outer two, where they are missing, from the inner two.
double mixed(const std::array<double, 4>& v, const std::array<double, 4>& weight) {
  double sum = 0;
  for (const std::size_t k : {1u, 2u})
    if (weight[k] != 0) sum += weight[k] * v[k];
  if (weight[0] != 0) sum += weight[0] * (std::isnan(v[0]) ? 2 * v[1] - v[2] : v[0]);
  if (weight[3] != 0) sum += weight[3] * (std::isnan(v[3]) ? 2 * v[2] - v[1] : v[3]);
  return sum;
}

/// The range of heights, which a cubic must not leave: at a cliff it would swing below a level sea.
class Range {
 public:
  void add(double height) {
    if (std::isnan(height)) return;
    low_ = std::min(low_, height), high_ = std::max(high_, height);
  }
  double nearest(double height) const { return std::clamp(height, low_, high_); }

 private:
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// Tells whether a place on an axis lies beyond its posts, where the height goes straight on.
bool isBeyond(const Axis& axis) {
  return axis.weight[1] < 0 || axis.weight[2] < 0;
}

}  // namespace

float heightBetween(const RasterWindow& window, std::int64_t across, std::int64_t down, double x, double y) {
  const auto at = [&](std::int64_t r, std::int64_t c) -> double {
    const std::int64_t i = r - window.row, j = c - window.column;
    if (i < 0 || j < 0 || i >= window.rows || j >= window.columns) return kVoid;
    return static_cast<double>(window.heights[static_cast<std::size_t>(i * window.columns + j)]);
  };
  if (!isWithinAPost(x, across) || !isWithinAPost(y, down)) return std::numeric_limits<float>::quiet_NaN();
  // A grid that has the file's posts asks for nothing else.
  const auto onColumn = static_cast<std::int64_t>(x), onRow = static_cast<std::int64_t>(y);
  if (static_cast<double>(onColumn) == x && static_cast<double>(onRow) == y && onColumn >= 0 && onRow >= 0 &&
      onColumn < across && onRow < down)
    return static_cast<float>(at(onRow, onColumn));
  const Axis column = axisAt(x, across), row = axisAt(y, down);
  std::optional<double> level;
  bool isLevel = true;
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      if (row.weight[static_cast<std::size_t>(j + 1)] == 0 ||
          column.weight[static_cast<std::size_t>(i + 1)] == 0)
        continue;
      const double h = at(row.post + j, column.post + i);
      if (std::isnan(h)) return std::numeric_limits<float>::quiet_NaN();
      if (level && h != *level) isLevel = false;
      level = h;
    }
  if (level && isLevel) return static_cast<float>(*level);
  Range range;
  std::array<double, 4> rows{};
  for (std::size_t j = 0; j < 4; ++j) {
    if (row.weight[j] == 0) continue;
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i)
      if (column.weight[i] != 0) {
        values[i] =
            at(row.post + static_cast<std::int64_t>(j) - 1, column.post + static_cast<std::int64_t>(i) - 1);
        range.add(values[i]);
      }
    rows[j] = mixed(values, column.weight);
  }
  const double height = mixed(rows, row.weight);
  return static_cast<float>(isBeyond(column) || isBeyond(row) ? height : range.nearest(height));
}

void PostMean::add(const RasterWindow& window, double x, double y, double width, double height) {
  const auto range = [](double middle, double size, std::int64_t first, std::int64_t count) {
    const double before = static_cast<double>(first),
                 from = std::max(std::ceil(middle - size / 2) - before, 0.0),
                 to = std::min(std::floor(middle + size / 2) - before, static_cast<double>(count - 1));
    if (!(from <= to)) return std::pair<std::int64_t, std::int64_t>{0, -1};
    return std::pair{static_cast<std::int64_t>(from), static_cast<std::int64_t>(to)};
  };
  const auto [left, right] = range(x, width, window.column, window.columns);
  const auto [low, high] = range(y, height, window.row, window.rows);
  for (std::int64_t r = low; r <= high; ++r)
    for (std::int64_t c = left; c <= right; ++c) {
      const float h = window.heights[static_cast<std::size_t>(r * window.columns + c)];
      ++posts_;
      if (!std::isnan(h)) sum_ += static_cast<double>(h), ++heights_;
    }
}

float PostMean::mean() const {
  if (2 * heights_ <= posts_ || heights_ == 0) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(sum_ / static_cast<double>(heights_));
}

float meanAbout(const RasterWindow& window, double x, double y, double width, double height) {
  PostMean posts;
  posts.add(window, x, y, width, height);
  return posts.mean();
}

float meanAlong(const RasterWindow& window, bool across, std::int64_t columns, std::int64_t rows, double x,
                double y, double size) {
  const double place = across ? y : x;
  const std::int64_t count = across ? rows : columns;
  if (!isWithinAPost(place, count)) return std::numeric_limits<float>::quiet_NaN();
  const Axis axis = axisAt(place, count);
  Range range;
  std::array<double, 4> means{};
  for (std::size_t k = 0; k < 4; ++k) {
    if (axis.weight[k] == 0) continue;
    const auto line = static_cast<double>(axis.post + static_cast<std::int64_t>(k) - 1);
    means[k] = static_cast<double>(across ? meanAbout(window, x, line, size, 0)
                                          : meanAbout(window, line, y, 0, size));
    range.add(means[k]);
  }
  // Level water, as between posts.
  if (axis.weight[1] != 0 && axis.weight[2] != 0 && means[1] == means[2]) return static_cast<float>(means[1]);
  const double height = mixed(means, axis.weight);
  return static_cast<float>(isBeyond(axis) || std::isnan(height) ? height : range.nearest(height));
}

}  // namespace trimtab::terrain
