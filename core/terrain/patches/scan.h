#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

/// Measures triangles and edges against the rows of a strip of posts.
namespace trimtab::terrain {

struct ScanVertex {
  std::int32_t x, y;  ///< column and row of the post
  double z;
};

/// Rows of posts in memory: post (x, y) is at z[(y - firstRow) * stride + (x - firstColumn)].
struct PostStrip {
  const float* z = nullptr;
  std::size_t stride = 0;
  std::int32_t firstColumn = 0, firstRow = 0;
  const float* row(std::int32_t y) const {
    return z + static_cast<std::size_t>(y - firstRow) * stride - firstColumn;
  }
};

/// The errors of a triangle at the posts of some of its rows.
struct ScanResult {
  double worst = 0;    ///< at the posts in it and on its edges
  double squares = 0;  ///< sum over the posts that belong to it; those on left and lower edges do
  std::uint32_t posts = 0;
};

/// A triangle that has an area, and its plane over columns and rows.
class ScanTriangle {
 public:
  ScanTriangle(const ScanVertex& a, const ScanVertex& b, const ScanVertex& c) : v_{a, b, c} {
    if (v_[1].y < v_[0].y) std::swap(v_[0], v_[1]);
    if (v_[2].y < v_[1].y) std::swap(v_[1], v_[2]);
    if (v_[1].y < v_[0].y) std::swap(v_[0], v_[1]);
    const double bx = v_[1].x - v_[0].x, by = v_[1].y - v_[0].y, cx = v_[2].x - v_[0].x,
                 cy = v_[2].y - v_[0].y;
    const double area2 = bx * cy - by * cx;
    const double bz = v_[1].z - v_[0].z, cz = v_[2].z - v_[0].z;
    byColumn_ = (bz * cy - cz * by) / area2;
    byRow_ = (bx * cz - cx * bz) / area2;
    long_ = cx / cy;
    low_ = by > 0 ? bx / by : 0;
    high_ = cy > by ? (cx - bx) / (cy - by) : 0;
  }
  std::int32_t firstRow() const { return v_[0].y; }
  std::int32_t lastRow() const { return v_[2].y; }
  double byColumn() const { return byColumn_; }
  double byRow() const { return byRow_; }

  /// Adds the errors in rows `first` to `last`, both within the triangle, to `result`; squares only of rows
  /// below `squaresEnd`.
  void scan(const PostStrip& strip, std::int32_t first, std::int32_t last, std::int32_t squaresEnd,
            ScanResult& result) const {
    double worst = 0, squares = 0;
    std::uint32_t posts = 0;
    for (std::int32_t y = first; y <= last; ++y) {
      const Span at = span(y);
      const float* const z = strip.row(y);
      // Crossings are exact but for 1e-10, and no nearer to a post than one over the rows of the triangle.
      constexpr double kIn = 1e-7;
      const auto from = static_cast<std::int32_t>(at.left + (1 - kIn)),
                 to = static_cast<std::int32_t>(at.right + kIn);
      const double start = v_[0].z + byRow_ * (y - v_[0].y) - byColumn_ * v_[0].x;
      double rowSquares = 0, off = 0;
      for (std::int32_t x = from; x <= to; ++x) {
        off = std::fabs(z[x] - (start + byColumn_ * x));
        worst = std::max(worst, off);
        rowSquares += off * off;
      }
      if (y < squaresEnd && y < v_[2].y && from <= to) {
        const bool onRight = to > at.right - kIn;
        squares += onRight ? rowSquares - off * off : rowSquares;
        posts += static_cast<std::uint32_t>(to - from + 1 - (onRight ? 1 : 0));
      }
    }
    result.worst = std::max(result.worst, worst);
    result.squares += squares;
    result.posts += posts;
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

  ScanVertex v_[3];
  double byColumn_, byRow_, long_, low_, high_;
};

/// Does what edgeError does, for an edge along neither a row nor a column.
double longEdgeError(ScanVertex a, ScanVertex b, const PostStrip& strip, std::int32_t first,
                     std::int32_t last, double worst);

/// Returns the larger of `worst` and the largest difference along an edge within one cell. There the
/// difference is a parabola from e0 to e1 whose second difference is 2 * bend.
inline double bentError(double e0, double e1, double bend, double worst) {
  worst = std::max(worst, std::fabs(e1));
  if (std::max(std::fabs(e0), std::fabs(e1)) + std::fabs(bend) / 4 <= worst) return worst;
  const double turn = (bend - (e1 - e0)) / (2 * bend);
  return turn > 0 && turn < 1 ? std::max(worst, std::fabs(e0 + turn * ((e1 - e0 - bend) + turn * bend)))
                              : worst;
}

/// Returns the larger of `worst` and the largest distance between an edge, which leads from post to post, and
/// the bilinear surface of the posts, in the rows of cells `first` to `last` - 1.
///
/// Over a whole mesh the largest distance is at a post or on an edge, because a plane minus a bilinear
/// surface is a saddle. Along rows and columns it is at posts, so those edges are skipped.
inline double edgeError(const ScanVertex& p, const ScanVertex& q, const PostStrip& strip, std::int32_t first,
                        std::int32_t last, double worst) {
  const ScanVertex &a = q.y < p.y ? q : p, &b = q.y < p.y ? p : q;
  const std::int32_t dx = b.x - a.x, dy = b.y - a.y;
  if (dx == 0 || dy == 0) return worst;
  // Fine meshes are made of short edges: these need no loop.
  const std::int32_t wide = std::abs(dx), cells = wide + dy;
  if (cells > 3 || a.y < first || b.y > last) return longEdgeError(a, b, strip, first, last, worst);
  const std::int32_t step = dx < 0 ? -1 : 1;
  const float* const z = strip.row(a.y) + a.x;
  const float* const up = z + strip.stride;
  const auto twist = [step](const float* south, const float* north) {
    return (static_cast<double>(north[step]) - south[step]) - (static_cast<double>(north[0]) - south[0]);
  };
  if (cells == 2) return std::max(worst, std::fabs(twist(z, up)) / 4);
  const double middle = (a.z + b.z) / 2;
  const bool high = dy == 2;
  const float* const south = high ? up : z + step;
  const float* const north = south + strip.stride;
  const double off = (static_cast<double>(south[0]) + (high ? south[step] : north[0])) / 2 - middle;
  worst = bentError(0, off, twist(z, up) / 2, worst);
  return bentError(off, 0, twist(south, north) / 2, worst);
}

}  // namespace trimtab::terrain
