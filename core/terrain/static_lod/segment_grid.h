#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace trimtab::terrain {

/// A place seen from above, metres.
struct Point {
  double x = 0, y = 0;
  friend Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
  friend Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
  friend Point operator*(double s, Point p) { return {s * p.x, s * p.y}; }
  friend double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
  double length() const { return std::hypot(x, y); }
};

struct Segment {
  Point a, b;
  double length() const { return (b - a).length(); }
  Point at(double share) const { return a + share * (b - a); }
  /// Returns the segment's nearest point to `p`.
  Point nearest(Point p) const {
    const Point along = b - a;
    const double squared = dot(along, along);
    return at(squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0);
  }
  double distance(Point p) const { return (nearest(p) - p).length(); }
};

/// Finds the nearest of many segments. Call finish() after the last add() and before the first nearest().
class SegmentGrid {
 public:
  void add(const Segment& s) { segments_.push_back(s); }
  void finish();
  bool empty() const { return segments_.empty(); }
  /// Returns the nearest segment that is less than `withinM` away; null if there is none.
  const Segment* nearest(Point p, double withinM = INFINITY) const;

 private:
  std::int64_t column(double x) const;
  std::int64_t row(double y) const;

  std::vector<Segment> segments_;
  Point low_;
  double cellM_ = 1;
  std::int64_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> firstOfCell_, inCell_;
};

}  // namespace trimtab::terrain
