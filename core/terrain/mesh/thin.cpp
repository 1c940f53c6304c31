#include "thin.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

using Vertex = Triangulation::Vertex;
using Triangle = Triangulation::Triangle;

}  // namespace

bool MeshThin::gatherRing(std::uint32_t v) {
  ring_.clear();
  std::int32_t h = starts_[v];
  do {
    const Triangle& one = mesh_.triangles[static_cast<std::size_t>(h >> 2)];
    const int i = h & 3;
    ring_.push_back({one.corner[Triangulation::next(i)], one.twin[Triangulation::next(i)], h >> 2});
    h = one.twin[Triangulation::before(i)];
  } while (h != starts_[v]);
  return ring_.size() <= kMostAbout;
}

/// Finds the fan that passes nearest to the vertex and within the bound of its post, from areas alone.
bool MeshThin::guess(std::uint32_t v, double bound, Removal& removal) {
  if (!gatherRing(v)) return false;
  const Vertex& at = mesh_.vertices[v];
  const std::size_t count = ring_.size();
  // The ring twice round, as seen from the vertex: whole numbers, and what is made of them is exact.
  double x[2 * kMostAbout], y[2 * kMostAbout], z[2 * kMostAbout], beside[2 * kMostAbout], area = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vertex& of = mesh_.vertices[ring_[i].vertex];
    x[i] = x[i + count] = of.x - at.x;
    y[i] = y[i + count] = of.y - at.y;
    z[i] = z[i + count] = static_cast<double>(of.z) - at.z;
  }
  const auto cross = [&](std::size_t i, std::size_t j) { return x[i] * y[j] - y[i] * x[j]; };
  for (std::size_t i = 0; i < count; ++i) area += beside[i] = beside[i + count] = cross(i, i + 1);
  const double own = fit_.offAt(at);
  double nearest = HUGE_VAL;
  for (std::size_t a = 0; a < count; ++a) {
    double before = beside[a], off = HUGE_VAL;
    std::size_t under = 0;
    bool open = true;
    for (std::size_t j = a + 1; j + 1 < a + count && open; ++j) {
      const double after = cross(a, j + 1), whole = before + beside[j] - after;
      open = whole > 0;
      // The first triangle of the fan beyond which the vertex does not lie.
      if (under == 0 && after < 0) {
        const double rise = (z[a] * beside[j] - z[j] * after + z[j + 1] * before) / whole;
        off = std::fabs(rise);
        under = j - a;
        open = open && off < nearest && std::fabs(own - rise) <= bound;
      }
      before = after;
    }
    if (!open || under == 0) continue;
    nearest = off;
    removal.from = static_cast<std::uint32_t>(a);
    removal.under = static_cast<std::uint32_t>(under);
  }
  if (nearest == HUGE_VAL) return false;
  // Squares of a pyramid so high over the triangles, and of its top.
  removal.cost = nearest * nearest * (area / 12 + 0.5);
  removal.vertex = v;
  removal.stamp = stamps_[v];
  removal.exact = false;
  return true;
}

bool MeshThin::measure(Removal& removal, double bound) {
  gatherRing(removal.vertex);
  const std::size_t last = ring_.size() - 2;
  const Vertex &at = mesh_.vertices[removal.vertex], &from = mesh_.vertices[ring_[removal.from].vertex];
  const double own = fit_.offAt(at);
  double cost = -own * own;
  for (const About& one : ring_) cost -= fit_.sums()[static_cast<std::size_t>(one.triangle)].squares;
  removal.sums = known_.size();
  known_.resize(known_.size() + last);
  // What breaks the bound mostly does so under the vertex.
  for (std::size_t i = 0, k = removal.under; i < last; ++i, k = k == last ? 1 : k + 1) {
    const About &b = ring_[along(removal.from, k)], &c = ring_[along(removal.from, k + 1)];
    const bool border[3] = {k == 1 && ring_[removal.from].outer < 0, b.outer < 0, k == last && c.outer < 0};
    const PostSum sum = fit_.sumOf(from, mesh_.vertices[b.vertex], mesh_.vertices[c.vertex], border);
    if (sum.worst > bound) {
      known_.resize(removal.sums);
      return false;
    }
    known_[removal.sums + k - 1] = sum;
    cost += sum.squares;
  }
  removal.cost = cost;
  removal.exact = true;
  return true;
}

void MeshThin::remove(const Removal& removal) {
  gatherRing(removal.vertex);
  const std::size_t last = ring_.size() - 2;
  const About& from = ring_[removal.from];
  starts_[removal.vertex] = -1;
  std::int32_t before = from.outer;
  for (std::size_t k = 1; k <= last; ++k) {
    const About &b = ring_[along(removal.from, k)], &c = ring_[along(removal.from, k + 1)];
    const std::int32_t t = b.triangle;
    Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
    one.corner[0] = from.vertex;
    one.corner[1] = b.vertex;
    one.corner[2] = c.vertex;
    mesh_.link(4 * t, before);
    mesh_.link(4 * t + 1, b.outer);
    before = 4 * t + 2;
    for (int i = 0; i < 3; ++i)
      if (starts_[one.corner[i]] >= 0) starts_[one.corner[i]] = 4 * t + i;
  }
  const About& end = ring_[along(removal.from, last + 1)];
  mesh_.link(before, end.outer);
  for (std::size_t k = 1; k <= last; ++k) {
    const std::int32_t t = ring_[along(removal.from, k)].triangle;
    fit_.sums()[static_cast<std::size_t>(t)] = known_[removal.sums + k - 1];
  }
  for (const About* one : {&from, &end})
    mesh_.triangles[static_cast<std::size_t>(one->triangle)].corner[0] = Triangulation::kDead;
  for (const About& one : ring_) ++stamps_[one.vertex];
}

std::size_t MeshThin::thin(std::size_t most, double bound) {
  const auto later = [](const Removal& a, const Removal& b) {
    return a.cost != b.cost ? a.cost > b.cost : a.vertex > b.vertex;
  };
  stamps_.assign(mesh_.vertices.size(), 0);
  known_.clear();
  std::vector<Removal> open;
  Removal one;
  for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
    if (starts_[v] >= 0 && guess(v, bound, one)) open.push_back(one);
  // Of guesses the worse ones are hardly ever wanted.
  std::vector<Removal> rest;
  if (const std::size_t likely = 3 * most; open.size() > likely) {
    const auto middle = open.begin() + static_cast<std::ptrdiff_t>(likely);
    std::nth_element(open.begin(), middle, open.end(),
                     [&](const Removal& a, const Removal& b) { return later(b, a); });
    rest.assign(middle, open.end());
    open.erase(middle, open.end());
  }
  std::make_heap(open.begin(), open.end(), later);
  std::size_t removed = 0;
  while (removed < most) {
    if (open.empty()) {
      if (rest.empty()) break;
      open.swap(rest);
      std::make_heap(open.begin(), open.end(), later);
    }
    std::pop_heap(open.begin(), open.end(), later);
    one = open.back();
    open.pop_back();
    if (one.stamp != stamps_[one.vertex]) {
      if (!guess(one.vertex, bound, one)) continue;
    } else if (!one.exact) {
      if (!measure(one, bound)) continue;
    } else {
      remove(one);
      ++removed;
      continue;
    }
    open.push_back(one);
    std::push_heap(open.begin(), open.end(), later);
  }
  compact();
  return removed;
}

void MeshThin::compact() {
  std::vector<std::int32_t> to;
  std::int32_t count = 0;
  to.reserve(mesh_.triangles.size());
  for (const Triangle& one : mesh_.triangles)
    to.push_back(one.corner[0] == Triangulation::kDead ? -1 : count++);
  for (std::size_t t = 0; t < to.size(); ++t) {
    if (to[t] < 0) continue;
    const auto now = static_cast<std::size_t>(to[t]);
    Triangle one = mesh_.triangles[t];
    for (int i = 0; i < 3; ++i)
      if (one.twin[i] < 0)
        mesh_.borderEdge[static_cast<std::size_t>(~one.twin[i])] = 4 * to[t] + i;
      else
        one.twin[i] = 4 * to[static_cast<std::size_t>(one.twin[i] >> 2)] + (one.twin[i] & 3);
    mesh_.triangles[now] = one;
    fit_.sums()[now] = fit_.sums()[t];
  }
  mesh_.triangles.resize(static_cast<std::size_t>(count));
  fit_.sums().resize(static_cast<std::size_t>(count));
}

}  // namespace trimtab::terrain
