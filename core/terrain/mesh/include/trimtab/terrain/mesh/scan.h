#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

#define TRIMTAB_INLINE [[gnu::always_inline]] inline

/// Returns `difference`, the height by which a post and a triangle differ (not negative), or 0 if rounding of
/// heights as large as `scale` explains it. Posts of a plane then have no error at all.
inline double roundedError(double difference, double scale) {
  return difference <= scale * 0x1p-38 ? 0.0 : difference;
}

/// The part of a row of posts that lies inside a triangle, with the triangle's heights there. With a `step`
/// of more than 1, rows and columns count only every step-th post.
struct FacetRow {
  std::int32_t y;            ///< the row
  std::int32_t first, last;  ///< the first and the last column inside
  double z;                  ///< the triangle's height at `first`, in the unit of the corners' heights
  double slope;              ///< how much the height grows from one column to the next
};

/// Calls `row(FacetRow)` for each row of posts inside a triangle, in the order of y. A post on an edge that
/// two triangles share belongs to the triangle on the side of larger x, or of larger y if the edge is level,
/// so that no post is visited twice. Corners are never visited, and neither are posts on an edge i, from
/// corner i to the next, with isBorder[i].
///
/// The corners are in either order, with coordinates from 0 to 2^15. Posts are the places whose x and y are
/// multiples of `step` (1 or more). With `everyRow` above 1 only one in so many of the triangle's own rows is
/// visited, beginning half as many above its lowest corner; a low triangle may then have none.
///
/// The ends of rows are computed in floating point and are exact. Where an edge crosses a row between two
/// posts, it is at least 1 / (rows of the triangle), so 2^-15 or more, away from both. The error of the
/// crossing is at most 2^15 additions of 2^-38 each, 2^-23, and the margins below are 2^-18.
template <class Row>
TRIMTAB_INLINE void forEachRow(const Triangulation::Vertex* const corner[3], const bool isBorder[3],
                               std::int32_t step, const Row& row, std::int32_t everyRow = 1) {
  using Vertex = Triangulation::Vertex;
  struct Corner {
    const Vertex* v;
    int i;
  };
  // The corners are sorted by y; of two with one y, the one of larger x comes first. If the two lowest share
  // their y, the middle one is then left of the long edge. Sorting by keys needs no branch that a processor
  // could mispredict.
  const auto key = [&](int i) {
    return (std::int64_t{corner[i]->y} << 34) + ((std::int64_t{1} << 31) - corner[i]->x) * 4 + i;
  };
  const std::int64_t k0 = key(0), k1 = key(1), k2 = key(2);
  const std::int64_t low01 = std::min(k0, k1), high01 = std::max(k0, k1);
  const auto cornerOf = [&](std::int64_t k) {
    const int i = static_cast<int>(k & 3);
    return Corner{corner[i], i};
  };
  const Corner a = cornerOf(std::min(low01, k2)), b = cornerOf(std::max(low01, std::min(high01, k2))),
               c = cornerOf(std::max(high01, k2));
  const std::int64_t area = Triangulation::turn(*a.v, *b.v, c.v->x, c.v->y);
  if (area == 1 || area == -1) return;  // by Pick's theorem it holds no post but its corners

  // Edge i of the triangle leads from corner i to the next.
  const auto borderOf = [&](const Corner& p, const Corner& q) {
    return isBorder[Triangulation::next(p.i) == q.i ? p.i : q.i];
  };
  const bool middleLeft = area < 0;
  const double det = static_cast<double>(area);
  const double za = a.v->z, bz = b.v->z - za, cz = c.v->z - za;
  const double bx = b.v->x - a.v->x, by = b.v->y - a.v->y, cx = c.v->x - a.v->x, cy = c.v->y - a.v->y;
  const double slopeX = (bz * cy - cz * by) / det, slopeY = (bx * cz - cx * bz) / det;
  // Along slivers the slopes are huge, and the two terms of a height nearly cancel. There the height at
  // `first` comes from areas, which are exact integers.
  const double wide = std::fmax(std::fabs(bx), std::fmax(std::fabs(cx), std::fabs(cx - bx)));
  const bool sliver = wide * cy > 1024.0 * std::fabs(det);

  constexpr double kIn = 1.0 - 0x1p-18, kOut = 1.0 + 0x1p-18;
  const double longStep = cx / cy;
  double longX = a.v->x;
  std::int32_t y = a.v->y;
  const std::int32_t rows = step * everyRow;
  const auto toPost = [step](std::int32_t from) { return (step - from % step) % step; };
  if (step != 1) {
    const std::int32_t skipped = toPost(y);
    y += skipped;
    longX += longStep * skipped;
  }
  y += everyRow / 2 * step;
  longX += longStep * (everyRow / 2 * step);
  for (int half = 0; half < 2; ++half) {
    const Corner& from = half == 0 ? a : b;
    const Corner& to = half == 0 ? b : c;
    const std::int32_t end = to.v->y;
    if (y >= end) continue;
    const double shortStep = static_cast<double>(to.v->x - from.v->x) / (to.v->y - from.v->y);
    double shortX = from.v->x + shortStep * (y - from.v->y);
    const bool leftBorder = middleLeft ? borderOf(from, to) : borderOf(a, c);
    const double left = leftBorder ? kOut : kIn;
    bool bottom = half == 1 && y == a.v->y && a.v->y == b.v->y && borderOf(a, b);
    bool atMiddle = half == 1 && middleLeft && y == b.v->y;
    for (; y < end; y += rows) {
      std::int32_t first = static_cast<std::int32_t>((middleLeft ? shortX : longX) + left);
      std::int32_t last = static_cast<std::int32_t>((middleLeft ? longX : shortX) + kIn) - 1;
      if (atMiddle) first = b.v->x + 1;
      if (step != 1) {
        first += toPost(first);
        last -= last < 0 ? 0 : last % step;
      }
      if (first <= last && !bottom) {
        double z;
        if (sliver) {
          const double wb = static_cast<double>(-Triangulation::turn(*a.v, *c.v, first, y));
          const double wc = static_cast<double>(Triangulation::turn(*a.v, *b.v, first, y));
          z = za + (wb * bz + wc * cz) / det;
        } else {
          z = za + slopeY * (y - a.v->y) + slopeX * (first - a.v->x);
        }
        if (step == 1)
          row(FacetRow{y, first, last, z, slopeX});
        else
          row(FacetRow{y / step, first / step, last / step, z, slopeX * step});
      }
      atMiddle = false;
      bottom = false;
      longX += longStep * rows;
      shortX += shortStep * rows;
    }
  }
}

}  // namespace trimtab::terrain
