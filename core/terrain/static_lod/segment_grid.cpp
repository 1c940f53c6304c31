#include "segment_grid.h"

namespace trimtab::terrain {

std::int64_t SegmentGrid::column(double x) const {
  return static_cast<std::int64_t>(std::clamp((x - low_.x) / cellM_, 0.0, static_cast<double>(columns_ - 1)));
}

std::int64_t SegmentGrid::row(double y) const {
  return static_cast<std::int64_t>(std::clamp((y - low_.y) / cellM_, 0.0, static_cast<double>(rows_ - 1)));
}

void SegmentGrid::finish() {
  if (segments_.empty()) return;
  Point high{-INFINITY, -INFINITY};
  low_ = {INFINITY, INFINITY};
  for (const Segment& s : segments_)
    for (const Point p : {s.a, s.b}) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  // About one segment a cell.
  const double count = static_cast<double>(segments_.size());
  const Point size = high - low_;
  cellM_ = std::max({0.25, std::sqrt(size.x * size.y / count), std::max(size.x, size.y) / count});
  columns_ = static_cast<std::int64_t>(size.x / cellM_) + 1;
  rows_ = static_cast<std::int64_t>(size.y / cellM_) + 1;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> uses;  // cell, segment
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    // The boxes of a long segment's pieces cover far fewer cells than its own box.
    const int pieces = 1 + static_cast<int>(segments_[i].length() / cellM_);
    for (int k = 0; k < pieces; ++k) {
      const Point a = segments_[i].at(static_cast<double>(k) / pieces),
                  b = segments_[i].at(static_cast<double>(k + 1) / pieces);
      for (std::int64_t y = row(std::min(a.y, b.y)); y <= row(std::max(a.y, b.y)); ++y)
        for (std::int64_t x = column(std::min(a.x, b.x)); x <= column(std::max(a.x, b.x)); ++x)
          uses.push_back({static_cast<std::uint32_t>(y * columns_ + x), i});
    }
  }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  firstOfCell_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const auto& [cell, segment] : uses) {
    ++firstOfCell_[cell + 1];
    inCell_.push_back(segment);
  }
  for (std::size_t i = 1; i < firstOfCell_.size(); ++i) firstOfCell_[i] += firstOfCell_[i - 1];
}

const Segment* SegmentGrid::nearest(Point p, double withinM) const {
  const Segment* best = nullptr;
  if (segments_.empty()) return best;
  const std::int64_t x0 = column(p.x), y0 = row(p.y);
  const auto visit = [&](std::int64_t x, std::int64_t y) {
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
    const auto cell = static_cast<std::size_t>(y * columns_ + x);
    for (std::uint32_t i = firstOfCell_[cell]; i < firstOfCell_[cell + 1]; ++i) {
      const double d = segments_[inCell_[i]].distance(p);
      if (d < withinM) withinM = d, best = &segments_[inCell_[i]];
    }
  };
  const std::int64_t rings = std::max(std::max(x0, columns_ - 1 - x0), std::max(y0, rows_ - 1 - y0));
  for (std::int64_t r = 0; r <= rings && static_cast<double>(r - 1) * cellM_ < withinM; ++r) {
    for (std::int64_t x = x0 - r; x <= x0 + r; ++x) {
      visit(x, y0 - r);
      if (r > 0) visit(x, y0 + r);
    }
    for (std::int64_t y = y0 - r + 1; y < y0 + r; ++y) {
      visit(x0 - r, y);
      visit(x0 + r, y);
    }
  }
  return best;
}

}  // namespace trimtab::terrain
