#include "patch_peer.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::bench {
namespace {

using terrain::HeightField;
using terrain::Triangulation;

class Peer {
 public:
  Peer(const HeightField& field, const std::vector<float>& allowedM) : field_(field), allowedM_(allowedM) {}

  std::size_t run() {
    const auto right = static_cast<std::int32_t>(field_.columns) - 1,
               top = static_cast<std::int32_t>(field_.rows) - 1;
    mesh_.vertices = {vertex(0, 0), vertex(right, 0), vertex(right, top), vertex(0, top)};
    mesh_.fillPolygon();
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh_.triangles.size()); ++t) scan(t);
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      if (changes_[static_cast<std::size_t>(next.triangle)] != next.change) continue;
      const Triangulation::Triangle& at = mesh_.triangles[static_cast<std::size_t>(next.triangle)];
      const auto v = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(vertex(at.postX, at.postY));
      mesh_.borderEdge.resize(mesh_.vertices.size(), -1);
      insert(next.triangle, v);
    }
    return mesh_.triangles.size();
  }

 private:
  struct Candidate {
    double times;
    std::int32_t triangle;
    unsigned change;
    bool operator<(const Candidate& o) const { return times < o.times; }
  };

  Triangulation::Vertex vertex(std::int32_t x, std::int32_t y) const {
    return {x, y, field_.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))};
  }

  void insert(std::int32_t triangle, std::uint32_t v) {
    const Triangulation::Triangle at = mesh_.triangles[static_cast<std::size_t>(triangle)];
    const Triangulation::Vertex p = mesh_.vertices[v];
    for (int i = 0; i < 3; ++i)
      if (at.twin[i] < 0 &&
          Triangulation::turn(mesh_.vertices[at.corner[i]], mesh_.vertices[at.corner[Triangulation::next(i)]],
                              p.x, p.y) == 0) {
        mesh_.splitBorder(at.corner[i], v);
        // From the border edge that leaves it round to the one that arrives.
        for (std::int32_t t = mesh_.borderEdge[v] >> 2;;) {
          scan(t);
          const Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
          const auto corner = static_cast<int>(std::find(one.corner, one.corner + 3, v) - one.corner);
          const std::int32_t twin = one.twin[Triangulation::before(corner)];
          if (twin < 0) return;
          t = twin >> 2;
        }
      }
    const std::int32_t about = mesh_.insert(triangle, v);
    std::int32_t t = about;
    do {
      scan(t);
      t = mesh_.triangles[static_cast<std::size_t>(t)].twin[1] >> 2;
    } while (t != about);
  }

  void scan(std::int32_t t) {
    if (changes_.size() < mesh_.triangles.size()) changes_.resize(2 * mesh_.triangles.size());
    ++changes_[static_cast<std::size_t>(t)];
    Triangulation::Triangle& one = mesh_.triangles[static_cast<std::size_t>(t)];
    const Triangulation::Vertex* const corner[3] = {
        &mesh_.vertices[one.corner[0]], &mesh_.vertices[one.corner[1]], &mesh_.vertices[one.corner[2]]};
    const Triangulation::Vertex &a = *corner[0], &b = *corner[1], &c = *corner[2];
    const auto twice = static_cast<double>(Triangulation::turn(a, b, c.x, c.y));
    const double byColumn =
        ((b.z - a.z) * double{1} * (c.y - a.y) - (c.z - a.z) * double{1} * (b.y - a.y)) / twice;
    const double byRow =
        ((c.z - a.z) * double{1} * (b.x - a.x) - (b.z - a.z) * double{1} * (c.x - a.x)) / twice;
    double most = 1 + 1e-9;
    bool any = false;
    for (std::int32_t y = std::min({a.y, b.y, c.y}); y <= std::max({a.y, b.y, c.y}); ++y) {
      double left = HUGE_VAL, right = -HUGE_VAL;
      for (int i = 0; i < 3; ++i) {
        const Triangulation::Vertex &p = *corner[i], &q = *corner[Triangulation::next(i)];
        if (y < std::min(p.y, q.y) || y > std::max(p.y, q.y)) continue;
        const double x = p.y == q.y ? p.x : p.x + static_cast<double>(q.x - p.x) * (y - p.y) / (q.y - p.y);
        left = std::min({left, x, p.y == q.y ? q.x : x});
        right = std::max({right, x, p.y == q.y ? q.x : x});
      }
      const std::size_t row = static_cast<std::size_t>(y) * field_.columns;
      for (auto x = static_cast<std::int32_t>(std::ceil(left - 1e-7)); x <= right + 1e-7; ++x) {
        const std::size_t post = row + static_cast<std::size_t>(x);
        const double off = std::fabs(field_.z[post] - (a.z + byColumn * (x - a.x) + byRow * (y - a.y)));
        if (off <= most * allowedM_[post]) continue;
        most = off / allowedM_[post];
        one.postX = x;
        one.postY = y;
        any = true;
      }
    }
    if (any) queue_.push({most, t, changes_[static_cast<std::size_t>(t)]});
  }

  const HeightField field_;
  const std::vector<float>& allowedM_;
  Triangulation mesh_;
  std::priority_queue<Candidate> queue_;
  std::vector<unsigned> changes_;
};

}  // namespace

std::size_t unconstrainedTriangles(const HeightField& field, const std::vector<float>& allowedM) {
  return Peer(field, allowedM).run();
}

}  // namespace trimtab::bench
