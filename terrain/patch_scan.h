#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

/// Triangles over the rows of a strip of posts.
namespace trimtab::terrain {

struct ScanVertex {
  std::int32_t x, y;  ///< post
  double z;
};

/// Rows in memory: post (x, y) is at z[(y - firstRow) * stride + (x - firstColumn)].
struct PostStrip {
  const float* z = nullptr;
  std::size_t stride = 0;
  std::int32_t firstColumn = 0, firstRow = 0;
  const float* row(std::int32_t y) const {
    return z + static_cast<std::size_t>(y - firstRow) * stride - firstColumn;
  }
};

/// What a triangle is off from the posts of some of its rows.
struct ScanResult {
  double worst = 0;    ///< at posts in it and on its edges
  double beside = 0;   ///< at these and all corners of cells that it touches: no less than `bilinear` gives
  double squares = 0;  ///< over the posts that belong to it: left and lower edges do
  std::uint32_t posts = 0;
};

/// A triangle with area; its plane over columns and rows.
class ScanTriangle {
 public:
  ScanTriangle(const ScanVertex& a, const ScanVertex& b, const ScanVertex& c) : v_{a, b, c} {
    if (v_[1].y < v_[0].y) std::swap(v_[0], v_[1]);
    if (v_[2].y < v_[1].y) std::swap(v_[1], v_[2]);
    if (v_[1].y < v_[0].y) std::swap(v_[0], v_[1]);
    const double bx = v_[1].x - v_[0].x, by = v_[1].y - v_[0].y, cx = v_[2].x - v_[0].x,
                 cy = v_[2].y - v_[0].y;
    area2_ = bx * cy - by * cx;
    const double bz = v_[1].z - v_[0].z, cz = v_[2].z - v_[0].z;
    byColumn_ = (bz * cy - cz * by) / area2_;
    byRow_ = (bx * cz - cx * bz) / area2_;
    long_ = cx / cy;
    low_ = by > 0 ? bx / by : 0;
    high_ = cy > by ? (cx - bx) / (cy - by) : 0;
  }
  std::int32_t firstRow() const { return v_[0].y; }
  std::int32_t lastRow() const { return v_[2].y; }
  double byColumn() const { return byColumn_; }
  double byRow() const { return byRow_; }
  /// Twice its area in cells.
  double area2() const { return std::fabs(area2_); }

  /// Rows first to last, both within the triangle's; squares only of rows below `squaresEnd`.
  void scan(const PostStrip& strip, std::int32_t first, std::int32_t last, std::int32_t squaresEnd,
            ScanResult& result) const {
    Span before = span(std::max(first - 1, v_[0].y)), now = span(first);
    double worst = 0, beside = 0, squares = 0;
    std::uint32_t posts = 0;
    for (std::int32_t y = first; y <= last; ++y) {
      const Span after = y < v_[2].y ? span(y + 1) : now;
      const float* const z = strip.row(y);
      // Crossings are exact but for 1e-11, and no nearer to a post than one over the rows of the triangle.
      constexpr double kIn = 1e-7;
      const auto from = static_cast<std::int32_t>(std::ceil(now.left - kIn)),
                 to = static_cast<std::int32_t>(std::floor(now.right + kIn));
      const auto low = static_cast<std::int32_t>(
                     std::floor(std::min({before.left, now.left, after.left}) + kIn)),
                 high = static_cast<std::int32_t>(
                     std::ceil(std::max({before.right, now.right, after.right}) - kIn));
      const double start = v_[0].z + byRow_ * (y - v_[0].y) - byColumn_ * v_[0].x;
      const auto off = [&](std::int32_t x) { return std::fabs(z[x] - (start + byColumn_ * x)); };
      for (std::int32_t x = low; x < from; ++x) beside = std::max(beside, off(x));
      double rowSquares = 0;
      for (std::int32_t x = from; x <= to; ++x) {
        const double e = off(x);
        worst = std::max(worst, e);
        rowSquares += e * e;
      }
      for (std::int32_t x = std::max(from, to + 1); x <= high; ++x) beside = std::max(beside, off(x));
      if (y < squaresEnd && y < v_[2].y && from <= to) {
        const bool onRight = to > now.right - kIn;
        if (onRight) {
          const double e = off(to);
          rowSquares -= e * e;
        }
        squares += rowSquares;
        posts += static_cast<std::uint32_t>(to - from + 1 - (onRight ? 1 : 0));
      }
      before = now;
      now = after;
    }
    result.worst = std::max(result.worst, worst);
    result.beside = std::max({result.beside, worst, beside});
    result.squares += squares;
    result.posts += posts;
  }

  /// Largest distance of its edges, between two rows of posts, from the bilinear surface: with what is at
  /// the posts in it the largest there is, as inside a cell the difference is a saddle.
  double bilinear(const PostStrip& strip, std::int32_t first, std::int32_t last) const {
    double worst = 0;
    for (int i = 0; i < 3; ++i)
      worst = std::max(worst, edge(v_[i], v_[i == 2 ? 0 : i + 1], strip, first, last));
    return worst;
  }

 private:
  struct Span {
    double left, right;
  };
  Span span(std::int32_t y) const {
    const double onLong = v_[0].x + (y - v_[0].y) * long_;
    const double onShort = y < v_[1].y || (y == v_[1].y && v_[1].y == v_[2].y && v_[0].y < v_[1].y)
                               ? v_[0].x + (y - v_[0].y) * low_
                               : v_[1].x + (y - v_[1].y) * high_;
    return onLong < onShort ? Span{onLong, onShort} : Span{onShort, onLong};
  }

  static double edge(ScanVertex a, ScanVertex b, const PostStrip& strip, std::int32_t first,
                     std::int32_t last) {
    if (b.y < a.y) std::swap(a, b);
    const std::int32_t low = std::max(a.y, first), high = std::min(b.y, last);
    if (low > high || (low == high && a.y != b.y)) return 0;
    const double dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
    if (a.y == b.y) {
      // Along a row of posts the surface is straight from one to the next: they are in the scan.
      return 0;
    }
    const double nx = dx / dy;
    double worst = 0;
    for (std::int32_t y = low; y < high; ++y) {
      // Within a row of cells, from crossing to crossing with columns.
      const float* const south = strip.row(y);
      const float* const north = south + strip.stride;
      double x0 = a.x + (y - a.y) * nx;
      const double x1 = a.x + (y + 1 - a.y) * nx;
      double v0 = 0;
      const double end = 1;
      while (v0 < end) {
        const double x = x0;
        std::int32_t cell;
        double next;
        if (nx > 0) {
          cell = static_cast<std::int32_t>(std::floor(x + 1e-7));
          next = std::min<double>(cell + 1, x1);
        } else {
          cell = static_cast<std::int32_t>(std::ceil(x - 1e-7)) - 1;
          next = std::max<double>(cell, x1);
        }
        if (nx == 0) break;  // along a column, straight as well
        const double v1 = next == x1 ? 1 : (next - a.x) / nx - (y - a.y);
        const double u0 = x - cell, u1 = next - cell;
        const double sw = south[cell], se = south[cell + 1], nw = north[cell], ne = north[cell + 1];
        const auto off = [&](double u, double v) {
          const double surface = sw + u * (se - sw) + v * (nw - sw + u * (ne - nw - se + sw));
          return surface - (a.z + dz * ((y - a.y) + v) / dy);
        };
        const double e0 = off(u0, v0), e1 = off(u1, v1);
        worst = std::max({worst, std::fabs(e0), std::fabs(e1)});
        // A parabola from e0 to e1 whose second difference is the cell's twist.
        const double q = (ne - nw - se + sw) * (u1 - u0) * (v1 - v0), l = e1 - e0 - q;
        if (q != 0) {
          const double s = -l / (2 * q);
          if (s > 0 && s < 1) worst = std::max(worst, std::fabs(e0 + s * (l + s * q)));
        }
        v0 = v1;
        x0 = next;
      }
    }
    return worst;
  }

  ScanVertex v_[3];
  double area2_, byColumn_, byRow_, long_, low_, high_;
};

}  // namespace trimtab::terrain
