#include "trimtab/terrain/static_lod/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab::terrain {

namespace {

/// Vertical distance of p to a triangle above or below it, in steps; none beside it.
std::optional<double> distance(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& p) {
  const std::int64_t area = orientation(a, b, c);
  if (area == 0) return std::nullopt;
  const std::int64_t sign = area > 0 ? 1 : -1;
  const std::int64_t wa = sign * orientation(b, c, p);
  if (wa < 0) return std::nullopt;
  const std::int64_t wb = sign * orientation(c, a, p);
  if (wb < 0) return std::nullopt;
  const std::int64_t wc = sign * orientation(a, b, p);
  if (wc < 0) return std::nullopt;
  const double sum = static_cast<double>(wa) * (a.z - p.z) + static_cast<double>(wb) * (b.z - p.z) +
                     static_cast<double>(wc) * (c.z - p.z);
  return std::abs(sum / static_cast<double>(sign * area));
}

}  // namespace

VerticalDistance::VerticalDistance(std::span<const Lattice> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles)
    : vertices_(vertices), triangles_(triangles) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  minX_ = minY_ = kMost;
  std::int32_t maxX = -kMost, maxY = -kMost;
  for (const auto& t : triangles)
    for (const std::uint32_t v : t) {
      minX_ = std::min(minX_, vertices[v].x), maxX = std::max(maxX, vertices[v].x);
      minY_ = std::min(minY_, vertices[v].y), maxY = std::max(maxY, vertices[v].y);
    }
  if (triangles.empty()) minX_ = minY_ = maxX = maxY = 0;
  // About one triangle a cell.
  const std::int64_t width = std::int64_t{maxX} - minX_ + 1, height = std::int64_t{maxY} - minY_ + 1;
  const double size = std::sqrt(static_cast<double>(width) * static_cast<double>(height) /
                                static_cast<double>(std::max<std::size_t>(triangles.size(), 1)));
  cell_ = std::max({std::int64_t{1}, static_cast<std::int64_t>(size), width / 4096, height / 4096});
  columns_ = width / cell_ + 1;
  rows_ = height / cell_ + 1;

  firstOfCell_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    forEachCell(t, [&](std::size_t cell) { ++firstOfCell_[cell + 1]; });
  for (std::size_t i = 1; i < firstOfCell_.size(); ++i) firstOfCell_[i] += firstOfCell_[i - 1];
  inCell_.resize(firstOfCell_.back());
  std::vector<std::uint32_t> end(firstOfCell_.begin(), firstOfCell_.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    forEachCell(t, [&](std::size_t cell) { inCell_[end[cell]++] = t; });
}

/// Visits the cells that a triangle may touch, row by row: a long thin one touches few of those in its box.
template <class Visit>
void VerticalDistance::forEachCell(std::uint32_t triangle, const Visit& visit) const {
  std::array<double, 3> x{}, y{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Lattice& p = vertices_[triangles_[triangle][k]];
    x[k] = static_cast<double>(std::int64_t{p.x} - minX_),
    y[k] = static_cast<double>(std::int64_t{p.y} - minY_);
  }
  const auto column = [&](double v) {
    return std::clamp(static_cast<std::int64_t>(v) / cell_, std::int64_t{0}, columns_ - 1);
  };
  const std::int64_t firstRow = static_cast<std::int64_t>(std::min({y[0], y[1], y[2]})) / cell_;
  const std::int64_t lastRow = static_cast<std::int64_t>(std::max({y[0], y[1], y[2]})) / cell_;
  for (std::int64_t row = firstRow; row <= lastRow; ++row) {
    const double low = static_cast<double>(row * cell_), high = static_cast<double>((row + 1) * cell_);
    double left = 1e18, right = -1e18;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t j = (k + 1) % 3;
      double x0 = x[k], y0 = y[k], x1 = x[j], y1 = y[j];
      if (y0 > y1) std::swap(x0, x1), std::swap(y0, y1);
      if (y1 < low || y0 > high) continue;
      const double slope = y1 > y0 ? (x1 - x0) / (y1 - y0) : 0;
      const double xa = y0 < low ? x0 + slope * (low - y0) : x0;
      const double xb = y1 > high ? x0 + slope * (high - y0) : x1;
      left = std::min({left, xa, xb});
      right = std::max({right, xa, xb});
    }
    if (left > right) continue;
    const std::int64_t last = column(right + 1);
    for (std::int64_t c = column(std::max(0.0, left - 1)); c <= last; ++c)
      visit(static_cast<std::size_t>(row * columns_ + c));
  }
}

/// Calls visit(triangle, distance in steps) for those of the triangles [first, last) that lie above or below
/// a place, until it returns false.
template <class Visit>
void VerticalDistance::forEachOver(const Lattice& p, std::uint32_t first, std::uint32_t last,
                                   const Visit& visit) const {
  const std::int64_t x = std::int64_t{p.x} - minX_, y = std::int64_t{p.y} - minY_;
  if (x < 0 || y < 0 || x / cell_ >= columns_ || y / cell_ >= rows_) return;
  const std::size_t cell = static_cast<std::size_t>(y / cell_ * columns_ + x / cell_);
  for (std::uint32_t i = firstOfCell_[cell]; i < firstOfCell_[cell + 1]; ++i) {
    const std::uint32_t t = inCell_[i];
    if (t < first || t >= last) continue;
    const auto& corners = triangles_[t];
    const auto d = distance(vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]], p);
    if (d && !visit(t, *d)) return;
  }
}

std::optional<double> VerticalDistance::metres(const Lattice& p, std::uint32_t first,
                                               std::uint32_t last) const {
  std::optional<double> nearest;
  forEachOver(p, first, last, [&](std::uint32_t, double d) {
    if (!nearest || d < *nearest) nearest = d;
    return true;
  });
  if (nearest) *nearest *= Lattice::kStepM;
  return nearest;
}

std::optional<std::uint32_t> VerticalDistance::at(const Lattice& p) const {
  std::optional<std::uint32_t> found;
  forEachOver(p, 0, std::numeric_limits<std::uint32_t>::max(), [&](std::uint32_t t, double) {
    found = t;
    return false;
  });
  return found;
}

}  // namespace trimtab::terrain
