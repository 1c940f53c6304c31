#include "trimtab/terrain/mesh/triangulation.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace trimtab::terrain {

namespace {

__extension__ using Wide = __int128;

/// The determinant's terms are products of up to four differences: 64 bits hold them for differences up to
/// this.
constexpr std::int64_t kNarrow = std::int64_t{1} << 14;

template <class Product>
bool positive(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by, std::int64_t cx,
              std::int64_t cy) {
  const Product a = ax * ax + ay * ay, b = bx * bx + by * by, c = cx * cx + cy * cy;
  return a * (bx * cy - by * cx) + b * (cx * ay - cy * ax) + c * (ax * by - ay * bx) > 0;
}

}  // namespace

bool Triangulation::inCircle(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  const std::int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                     cy = c.y - d.y;
  // |v| of every difference at once: or-ing v with its complement's sign folds keeps the highest bit.
  const auto size = [](std::int64_t v) { return v ^ (v >> 63); };
  const std::int64_t bits = size(ax) | size(ay) | size(bx) | size(by) | size(cx) | size(cy);
  return bits < kNarrow ? positive<std::int64_t>(ax, ay, bx, by, cx, cy)
                        : positive<Wide>(ax, ay, bx, by, cx, cy);
}

void Triangulation::fillPolygon() {
  const auto n = static_cast<std::uint32_t>(vertices.size());
  triangles.clear();
  borderEdge.assign(n, -1);
  stack_.clear();

  // A fan of the true corners has only triangles with area; what lies on the sides then splits them.
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vertex& after = vertices[i + 1 == n ? 0 : i + 1];
    if (turn(vertices[i == 0 ? n - 1 : i - 1], vertices[i], after.x, after.y) > 0) corners.push_back(i);
  }
  assert(corners.size() >= 3);
  if (corners.size() < 3) return;
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) {
    const auto t = static_cast<std::int32_t>(triangles.size());
    triangles.push_back({{corners[k], corners[k + 1], corners[0]}, {-1, -1, -1}, 0, 0});
    link(4 * t, ~static_cast<std::int32_t>(corners[k]));
    if (k == 1)
      link(4 * t + 2, ~static_cast<std::int32_t>(corners[0]));
    else
      link(4 * t + 2, 4 * (t - 1) + 1);
    if (k + 2 == corners.size()) link(4 * t + 1, ~static_cast<std::int32_t>(corners[k + 1]));
  }
  // Diagonals of the fan: corner 2 of one of the triangles must be opposite, so look at them turned round.
  bool flipped = corners.size() > 3;
  while (flipped) {
    flipped = false;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t)
      for (int i = 0; i < 3; ++i) {
        Triangle& at = triangles[static_cast<std::size_t>(t)];
        const std::int32_t other = at.twin[i];
        if (other < 0) continue;
        const Vertex& d = vertices[triangles[static_cast<std::size_t>(other >> 2)].corner[before(other & 3)]];
        if (!inCircle(vertices[at.corner[0]], vertices[at.corner[1]], vertices[at.corner[2]], d)) continue;
        const Triangle was = at;
        for (int k = 0; k < 3; ++k) at.corner[k] = was.corner[(i + k) % 3];
        for (int k = 0; k < 3; ++k) link(4 * t + k, was.twin[(i + k) % 3]);
        flip(t);
        flipped = true;
        break;
      }
  }

  // Middles first, or a long side would be split from one end and flipped through again and again.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (std::size_t k = 0; k < corners.size(); ++k)
    sides.push_back({corners[k], k + 1 < corners.size() ? corners[k + 1] : corners[0] + n});
  while (!sides.empty()) {
    const auto [from, to] = sides.back();
    sides.pop_back();
    if (to - from < 2) continue;
    const std::uint32_t middle = from + (to - from) / 2;
    splitBorder(from % n, middle % n);
    sides.push_back({from, middle});
    sides.push_back({middle, to});
  }
}

void Triangulation::splitBorder(std::uint32_t from, std::uint32_t v) {
  if (borderEdge.size() < vertices.size()) borderEdge.resize(vertices.size(), -1);
  const std::int32_t h = borderEdge[from];
  const std::int32_t t = h >> 2;
  const int i = h & 3;
  const Triangle was = triangles[static_cast<std::size_t>(t)];
  const std::uint32_t a = was.corner[i], b = was.corner[next(i)], c = was.corner[before(i)];
  const auto u = static_cast<std::int32_t>(triangles.size());
  triangles.push_back({{c, a, v}, {-1, -1, -1}, 0, 0});
  triangles[static_cast<std::size_t>(t)] = {{b, c, v}, {-1, -1, -1}, 0, 0};
  link(4 * t, was.twin[next(i)]);
  link(4 * t + 1, 4 * u + 2);
  link(4 * t + 2, ~static_cast<std::int32_t>(v));
  link(4 * u, was.twin[before(i)]);
  link(4 * u + 1, ~static_cast<std::int32_t>(a));
  stack_.push_back(t);
  stack_.push_back(u);
  legalize();
}

std::int32_t Triangulation::insert(std::int32_t t, std::uint32_t v) {
  const Triangle was = triangles[static_cast<std::size_t>(t)];
  const Vertex p = vertices[v];
  int on = -1;
  for (int i = 0; i < 3; ++i)
    if (turn(vertices[was.corner[i]], vertices[was.corner[next(i)]], p.x, p.y) == 0) on = i;
  const auto added = static_cast<std::int32_t>(triangles.size());
  if (on < 0) {
    triangles.resize(triangles.size() + 2);
    const std::int32_t ids[3] = {t, added, added + 1};
    for (int i = 0; i < 3; ++i) {
      Triangle& one = triangles[static_cast<std::size_t>(ids[i])];
      one = {{was.corner[i], was.corner[next(i)], v}, {-1, -1, -1}, 0, 0};
      one.twin[1] = 4 * ids[next(i)] + 2;
      one.twin[2] = 4 * ids[before(i)] + 1;
      stack_.push_back(ids[i]);
    }
    for (int i = 0; i < 3; ++i) link(4 * ids[i], was.twin[i]);
  } else {
    const std::int32_t other = was.twin[on];
    assert(other >= 0);
    const std::int32_t u = other >> 2;
    const int j = other & 3;
    const Triangle wasU = triangles[static_cast<std::size_t>(u)];
    triangles.resize(triangles.size() + 2);
    const std::uint32_t ring[4] = {was.corner[next(on)], was.corner[before(on)], was.corner[on],
                                   wasU.corner[before(j)]};
    const std::int32_t ids[4] = {t, added, u, added + 1};
    const std::int32_t outer[4] = {was.twin[next(on)], was.twin[before(on)], wasU.twin[next(j)],
                                   wasU.twin[before(j)]};
    for (int i = 0; i < 4; ++i) {
      Triangle& one = triangles[static_cast<std::size_t>(ids[i])];
      one = {{ring[i], ring[(i + 1) & 3], v}, {-1, -1, -1}, 0, 0};
      one.twin[1] = 4 * ids[(i + 1) & 3] + 2;
      one.twin[2] = 4 * ids[(i + 3) & 3] + 1;
      stack_.push_back(ids[i]);
    }
    for (int i = 0; i < 4; ++i) link(4 * ids[i], outer[i]);
  }
  legalize();
  return t;
}

void Triangulation::flip(std::int32_t t) {
  Triangle& one = triangles[static_cast<std::size_t>(t)];
  const std::int32_t other = one.twin[0];
  const std::int32_t u = other >> 2;
  const int j = other & 3;
  Triangle& two = triangles[static_cast<std::size_t>(u)];
  const std::uint32_t b = one.corner[1], p = one.corner[2], d = two.corner[before(j)];
  const std::int32_t bp = one.twin[1], ad = two.twin[next(j)], db = two.twin[before(j)];
  one.corner[1] = d;
  two.corner[0] = d;
  two.corner[1] = b;
  two.corner[2] = p;
  link(4 * t, ad);
  link(4 * u, db);
  link(4 * u + 1, bp);
  link(4 * t + 1, 4 * u + 2);
}

void Triangulation::legalize() {
  while (!stack_.empty()) {
    const std::int32_t t = stack_.back();
    stack_.pop_back();
    for (;;) {
      const Triangle& one = triangles[static_cast<std::size_t>(t)];
      const std::int32_t other = one.twin[0];
      if (other < 0) break;
      const Triangle& two = triangles[static_cast<std::size_t>(other >> 2)];
      const Vertex& d = vertices[two.corner[before(other & 3)]];
      if (!inCircle(vertices[one.corner[0]], vertices[one.corner[1]], vertices[one.corner[2]], d)) break;
      flip(t);
      stack_.push_back(other >> 2);
    }
  }
}

}  // namespace trimtab::terrain
