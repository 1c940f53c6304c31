#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "trimtab/terrain/mesh/scan.h"

/// Visits the posts of a triangle four at a time. The same source is compiled for wide registers and for
/// narrow ones. Sums are formed lane by lane, and the lanes are added in one order, so that every machine
/// makes the same mesh to the bit.
///
/// The mesher does not use trimtab/units/simd.h, because the number of lanes there is that of the processor's
/// registers. A rounded sum of errors depends on how many lanes share it; with 4 on one machine and 8 on
/// another, two parts of a bake would differ where two posts have nearly the same error. Here the compiler's
/// vector types fix four lanes of doubles, and a processor with narrower registers computes the same four in
/// two steps.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(TRIMTAB_PLAIN_LANES) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRIMTAB_LANES [[gnu::target_clones("avx2", "default")]]
#else
#define TRIMTAB_LANES
#endif

namespace trimtab::terrain {

constexpr std::int32_t kLanes = 4;
using Lanes = double __attribute__((vector_size(32)));
using LaneFloats = float __attribute__((vector_size(16)));
using LaneMask = std::int64_t __attribute__((vector_size(32)));

/// Heights under a mesh, counted from the mesh's origin.
struct PostRows {
  const float* z;
  std::size_t stride;
  std::int32_t columns;  ///< how many posts of a row may be read
  const float* row(std::int32_t y) const { return z + static_cast<std::size_t>(y) * stride; }
};

/// Returns the sum of the lanes, always added in the same order.
TRIMTAB_INLINE double sumOfLanes(const Lanes& v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}
/// Returns the largest lane.
TRIMTAB_INLINE double mostOfLanes(const Lanes& v) {
  return std::max(std::max(v[0], v[2]), std::max(v[1], v[3]));
}
/// Writes the absolute value of each lane into `out`.
TRIMTAB_INLINE void absoluteLanes(const Lanes& v, Lanes& out) {
  out = reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(v) & INT64_MAX);
}

/// Finds the lowest and the highest of many heights.
class LaneRange {
 public:
  LaneRange(float low, float high) : low_(LaneFloats{} + low), high_(LaneFloats{} + high) {}
  void add(const float* from, const float* end) {
    for (; end - from >= kLanes; from += kLanes) {
      LaneFloats z;
      std::memcpy(&z, from, sizeof z);
      add(z);
    }
    for (; from < end; ++from) add(LaneFloats{} + *from);
  }
  float low() const { return std::min(std::min(low_[0], low_[1]), std::min(low_[2], low_[3])); }
  float high() const { return std::max(std::max(high_[0], high_[1]), std::max(high_[2], high_[3])); }

 private:
  void add(const LaneFloats& z) {
    low_ = z < low_ ? z : low_;
    high_ = z > high_ ? z : high_;
  }
  LaneFloats low_, high_;
};

/// Calls `four(off, x, y)` for the posts that forEachRow visits at step 1. Lane k of `off` is how far post (x
/// + k, y) lies above the triangle, metres; it is 0 if that post is not one to visit. `everyRow` is as in
/// forEachRow.
template <class Four>
TRIMTAB_INLINE void forEachFour(const Triangulation::Vertex* const corner[3], const bool isBorder[3],
                                const PostRows& posts, const Four& four, std::int32_t everyRow = 1) {
  const Triangulation::Vertex &a = *corner[0], &b = *corner[1], &c = *corner[2];
  const std::int64_t area = Triangulation::turn(a, b, c.x, c.y);
  if (area == 1) return;  // no post but its corners
  constexpr Lanes kCount{0, 1, 2, 3};
  const double perArea = 1 / static_cast<double>(area);
  const double za = a.z, toB = (b.z - za) * perArea, toC = (c.z - za) * perArea;
  const std::int32_t west = std::min({a.x, b.x, c.x}), east = std::max({a.x, b.x, c.x});
  const auto load = [&](const float* from, Lanes& z) __attribute__((always_inline)) {
    LaneFloats f;
    std::memcpy(&f, from, sizeof f);
    z = __builtin_convertvector(f, Lanes);
  };

  // Posts of its own lie right of its leftmost corner and above its lowest, but for edges along columns and
  // rows there.
  const std::int32_t low = std::min({a.y, b.y, c.y}), high = std::max({a.y, b.y, c.y});
  const std::int32_t top = low + ((a.y == low) + (b.y == low) + (c.y == low) == 2 ? 0 : 1);
  const std::int32_t left = west + ((a.x == west) + (b.x == west) + (c.x == west) == 2 ? 0 : 1);
  if ((left >= east) | (top >= high)) return;
  constexpr std::int32_t kWidest = 2 * kLanes;
  if (east - left <= kWidest && posts.columns >= kLanes && everyRow == 1) {
    // Twice the areas beside the three edges: whole numbers, so that sums of them are exact. On left edges
    // and lower ones they may be 0, beside others they are less by a half to tell the two apart; at a corner
    // one of them is the whole.
    struct Edge {
      double less, right, up, start;
    };
    const auto edge = [&](const Triangulation::Vertex& from, const Triangulation::Vertex& to, bool border)
        __attribute__((always_inline)) {
      const std::int32_t dx = to.x - from.x, dy = to.y - from.y;
      // The direction of edges cannot be guessed, so this has no branches.
      constexpr double kLess[2] = {0.5, 0.0};
      const double less = kLess[(!border) & ((dy < 0) | ((dy == 0) & (dx > 0)))];
      return Edge{
          less, static_cast<double>(-dy), static_cast<double>(dx),
          static_cast<double>(dx) * (top - from.y) - static_cast<double>(dy) * (left - from.x) - less};
    };
    const Edge ab = edge(a, b, isBorder[0]), bc = edge(b, c, isBorder[1]), ca = edge(c, a, isBorder[2]);
    const double nearCorner = static_cast<double>(area) - 0.75, zLess = za + (ca.less * toB + ab.less * toC);
    for (std::int32_t x = left; x < east; x += kLanes) {
      // The last columns come with some before them, which are not counted twice.
      const std::int32_t first = std::min(x, posts.columns - kLanes);
      const Lanes along = kCount + static_cast<double>(first - left);
      const LaneMask fresh = kCount >= static_cast<double>(x - first);
      Lanes e0 = ab.start + ab.right * along, e1 = bc.start + bc.right * along,
            e2 = ca.start + ca.right * along;
      const float* row = posts.row(top) + first;
      for (std::int32_t y = top; y < high; ++y, row += posts.stride) {
        const Lanes l01 = e0 < e1 ? e0 : e1, h01 = e0 < e1 ? e1 : e0, least = l01 < e2 ? l01 : e2,
                    most = h01 < e2 ? e2 : h01;
        const LaneMask in = (least >= 0.0) & (most < nearCorner) & fresh;
        Lanes z;
        load(row, z);
        const Lanes off = z - (zLess + (e2 * toB + e0 * toC));
        four(reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(off) & in), first, y);
        e0 += ab.up;
        e1 += bc.up;
        e2 += ca.up;
      }
    }
    return;
  }

  forEachRow(
      corner, isBorder, 1,
      [&](const FacetRow& r) __attribute__((always_inline)) {
        const float* const row = posts.row(r.y);
        for (std::int32_t x = r.first; x <= r.last; x += kLanes) {
          Lanes z;
          if (x + kLanes <= posts.columns) {
            load(row + x, z);
          } else {
            float rest[kLanes] = {};
            std::copy(row + x, row + r.last + 1, rest);
            load(rest, z);
          }
          const Lanes along = kCount + static_cast<double>(x - r.first);
          const LaneMask in = along <= static_cast<double>(r.last - r.first);
          const Lanes off = z - (r.z + r.slope * along);
          four(reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(off) & in), x, r.y);
        }
      },
      everyRow);
}

}  // namespace trimtab::terrain
