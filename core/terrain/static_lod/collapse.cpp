#include "collapse.h"

#include <algorithm>
#include <cmath>

#include "texture.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// Orders collapses that cost nothing (sea, plains): short edges first. A share of the area, m^2 a m^2.
constexpr double kLengthCost = 1e-8;

/// Says how thin and how steep a triangle may become where those it replaces are neither.
struct Shape {
  double thinnest;  ///< twice the area over the longest edge squared, from above
  double steepest;  ///< rise over run
};
constexpr Shape kGoodShape{0.001, 3.0}, kAnyShape{1e-5, 50.0};

class Collapser {
 public:
  Collapser(Patch& patch, std::vector<std::uint8_t>& alive) : patch_(patch), alive_(alive) {
    const std::size_t vertices = patch.vertices.size();
    alive_.assign(patch.triangles.size(), 1);
    left_ = patch.triangles.size();
    head_.assign(vertices, kNone);
    tail_.assign(vertices, kNone);
    next_.assign(patch.triangles.size() * 3, kNone);
    version_.assign(vertices, 0);
    mark_.assign(vertices, 0);
    waiting_.assign(vertices, 0);
    places_.reserve(vertices);
    for (const Patch::Vertex& v : patch.vertices) places_.push_back(metres(v.at));
    for (std::uint32_t c = 0; c < next_.size(); ++c) append(corner(c), c);
  }

  bool run(std::size_t target, Shape shape) {
    shape_ = shape;
    heap_.clear();
    std::fill(waiting_.begin(), waiting_.end(), std::uint8_t{0});
    for (std::size_t t = 0; t < alive_.size(); ++t)
      if (alive_[t])
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = patch_.triangles[t][k], b = patch_.triangles[t][(k + 1) % 3];
          if (a < b) offer(a, b, 0);  // an edge with an end that is free has two sides: once this way round
        }
    while (left_ > target + 1 && !heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), later);
      const Candidate c = heap_.back();
      heap_.pop_back();
      if (version_[c.u] != c.versionU || version_[c.v] != c.versionV) continue;
      tryCollapse(c);
    }
    return left_ <= target + 1;
  }

 private:
  /// Says where the new vertex goes; each is tried when the one before it would fold the surface.
  enum Way : std::uint8_t { kSolved, kBetween, kAtBetter, kAtOther, kWays };

  struct Candidate {
    double cost;
    std::uint32_t u, v, versionU, versionV;
    std::uint8_t way;
  };
  static bool later(const Candidate& a, const Candidate& b) {
    if (a.cost != b.cost) return a.cost > b.cost;
    return a.u != b.u ? a.u > b.u : a.v > b.v;
  }
  struct Placed {
    Lattice at;
    std::uint32_t end = kNone;  ///< it is this vertex, unmoved
  };

  std::uint32_t& corner(std::uint32_t c) { return patch_.triangles[c / 3][c % 3]; }
  Vec3 metres(const Lattice& p) const { return p.metres() - patch_.origin.metres(); }
  void append(std::uint32_t v, std::uint32_t c) {
    if (head_[v] == kNone) {
      head_[v] = c;
    } else {
      next_[tail_[v]] = c;
    }
    tail_[v] = c;
  }

  /// Finds the corners of a vertex whose triangles are left; forgets the others.
  void fanOf(std::uint32_t v, std::vector<std::uint32_t>& fan) {
    fan.clear();
    std::uint32_t last = kNone;
    for (std::uint32_t c = head_[v]; c != kNone; c = next_[c])
      if (alive_[c / 3]) {
        (last == kNone ? head_[v] : next_[last]) = c;
        last = c;
        fan.push_back(c);
      }
    if (last == kNone) {
      head_[v] = tail_[v] = kNone;
    } else {
      next_[last] = kNone;
      tail_[v] = last;
    }
  }

  Lattice rounded(Vec3 p) const {
    const auto step = [](double m) { return static_cast<std::int32_t>(std::lround(m / Lattice::kStepM)); };
    return {patch_.origin.x + step(p.x), patch_.origin.y + step(p.y), patch_.origin.z + step(p.z)};
  }

  Placed unmoved(std::uint32_t v) const { return {patch_.vertices[v].at, v}; }

  std::optional<Placed> place(std::uint32_t u, std::uint32_t v, std::uint8_t way, const Quadric& q) const {
    const bool lockedU = patch_.vertices[u].locked, lockedV = patch_.vertices[v].locked;
    if (lockedU || lockedV) {
      if (way != kAtBetter) return std::nullopt;
      return unmoved(lockedU ? u : v);
    }
    const Vec3 a = places_[u], b = places_[v], middle = 0.5 * (a + b);
    if (way == kSolved) {
      const auto least = q.least(middle);
      const Vec3 edge = b - a;
      if (!least || dot(*least - middle, *least - middle) > dot(edge, edge)) return std::nullopt;
      return atEndIfEqual(u, v, rounded(*least));
    }
    if (way == kBetween) return atEndIfEqual(u, v, rounded(q.leastBetween(a, b)));
    return unmoved((q.at(a) <= q.at(b)) == (way == kAtBetter) ? u : v);
  }
  Placed atEndIfEqual(std::uint32_t u, std::uint32_t v, const Lattice& p) const {
    if (p == patch_.vertices[u].at) return unmoved(u);
    if (p == patch_.vertices[v].at) return unmoved(v);
    return {p, kNone};
  }

  /// Queues the collapse of an edge by the first way from `way` on that there is.
  bool offer(std::uint32_t u, std::uint32_t v, std::uint8_t way) {
    if (patch_.vertices[u].locked && patch_.vertices[v].locked) return false;
    const Quadric q = patch_.vertices[u].quadric + patch_.vertices[v].quadric;
    for (; way < kWays; ++way)
      if (const auto placed = place(u, v, way, q)) {
        const Vec3 edge = places_[v] - places_[u];
        const double cost = q.at(metres(placed->at)) + kLengthCost * q.weight() * dot(edge, edge);
        heap_.push_back({cost, u, v, version_[u], version_[v], way});
        std::push_heap(heap_.begin(), heap_.end(), later);
        return true;
      }
    return false;
  }

  void tryCollapse(const Candidate& c) {
    fanOf(c.u, fanU_);
    fanOf(c.v, fanV_);
    if (linked(c.u, c.v)) {
      const Quadric q = patch_.vertices[c.u].quadric + patch_.vertices[c.v].quadric;
      const auto placed = place(c.u, c.v, c.way, q);
      if (placed && fits(c.u, c.v, *placed)) return collapse(c.u, c.v, *placed, q);
      if (offer(c.u, c.v, static_cast<std::uint8_t>(c.way + 1))) return;
    }
    waiting_[c.u] = waiting_[c.v] = 1;
  }

  /// Link condition: two triangles at the edge, and no vertex next to both ends but those two's tips.
  bool linked(std::uint32_t u, std::uint32_t v) {
    ++stamp_;
    std::size_t sides = 0, common = 0;
    for (const std::uint32_t c : fanU_)
      for (const std::uint32_t x : patch_.triangles[c / 3]) {
        sides += x == v;
        if (x != u) mark_[x] = stamp_;
      }
    if (sides != 2) return false;
    for (const std::uint32_t c : fanV_)
      for (const std::uint32_t x : patch_.triangles[c / 3])
        if (x != u && x != v && mark_[x] == stamp_) {
          mark_[x] = 0;
          ++common;
        }
    return common == 2;
  }

  static double thinness(std::int64_t area, const Lattice& a, const Lattice& b, const Lattice& c) {
    const auto squared = [](const Lattice& p, const Lattice& q) {
      const double x = static_cast<double>(p.x) - q.x, y = static_cast<double>(p.y) - q.y;
      return x * x + y * y;
    };
    return static_cast<double>(area) / std::max({squared(a, b), squared(b, c), squared(c, a), 1.0});
  }

  /// Reports whether every triangle that stays still faces up and is no worse than what the neighbourhood
  /// had.
  bool fits(std::uint32_t u, std::uint32_t v, const Placed& placed) {
    double thinnest = shape_.thinnest, steepest = shape_.steepest;
    double newThinnest = 1e9, newSteepest = 0;
    for (const auto* fan : {&fanU_, &fanV_})
      for (const std::uint32_t corner : *fan) {
        const auto& t = patch_.triangles[corner / 3];
        std::array<Lattice, 3> was;
        for (std::size_t k = 0; k < 3; ++k) was[k] = patch_.vertices[t[k]].at;
        thinnest = std::min(thinnest, thinness(orientation(was[0], was[1], was[2]), was[0], was[1], was[2]));
        steepest = std::max(steepest, slopeOf(was[0], was[1], was[2]));
        const std::uint32_t own = t[corner % 3], other = own == u ? v : u;
        if (t[0] == other || t[1] == other || t[2] == other) continue;  // goes
        if (own == placed.end) {
          continue;  // stays as it is
        }
        std::array<Lattice, 3> now = was;
        now[corner % 3] = placed.at;
        const std::int64_t area = orientation(now[0], now[1], now[2]);
        if (area <= 0) return false;
        newThinnest = std::min(newThinnest, thinness(area, now[0], now[1], now[2]));
        newSteepest = std::max(newSteepest, slopeOf(now[0], now[1], now[2]));
      }
    return newThinnest >= thinnest && newSteepest <= steepest;
  }

  void collapse(std::uint32_t u, std::uint32_t v, const Placed& placed, const Quadric& q) {
    const bool keepsV = placed.end == v;
    const std::uint32_t kept = keepsV ? v : u, gone = keepsV ? u : v;
    const auto& fanKept = keepsV ? fanV_ : fanU_;
    const auto& fanGone = keepsV ? fanU_ : fanV_;
    if (!patch_.texture.empty()) collapseTexture(u, v, placed);
    for (const std::uint32_t c : fanKept)
      for (const std::uint32_t x : patch_.triangles[c / 3])
        if (x == gone) {
          alive_[c / 3] = 0;
          --left_;
        }
    for (const std::uint32_t c : fanGone)
      if (alive_[c / 3]) {
        corner(c) = kept;
        next_[c] = kNone;
        append(kept, c);
      }
    Patch::Vertex& vertex = patch_.vertices[kept];
    vertex.quadric = q;
    vertex.normal = vertex.normal + patch_.vertices[gone].normal;
    if (placed.end == kNone) {
      vertex.at = placed.at;
      vertex.moved = true;
      places_[kept] = metres(placed.at);
    }
    head_[gone] = tail_[gone] = kNone;
    ++version_[kept];
    ++version_[gone];
    offerAround(kept);
  }

  void collapseTexture(std::uint32_t u, std::uint32_t v, const Placed& placed) {
    wedgeCorners_.clear();
    wedgePlaces_.clear();
    for (const auto* fan : {&fanU_, &fanV_})
      for (const std::uint32_t c : *fan) {
        const auto& t = patch_.triangles[c / 3];
        const bool second = fan == &fanV_;
        wedgeCorners_.push_back({c, second, std::find(t.begin(), t.end(), second ? u : v) != t.end()});
        wedgePlaces_.push_back({places_[t[0]], places_[t[1]], places_[t[2]]});
      }
    std::optional<bool> end;
    if (placed.end != kNone) end = placed.end == v;
    wedges_.run(wedgeCorners_, end, metres(placed.at), wedgePlaces_, patch_.texture);
  }

  void offerAround(std::uint32_t centre) {
    fanOf(centre, fanU_);
    ring(centre, fanU_, ring_);
    for (const std::uint32_t x : ring_) offer(centre, x, 0);
    // A collapse that was impossible next to here may be possible now.
    for (const std::uint32_t x : ring_)
      if (waiting_[x]) {
        waiting_[x] = 0;
        fanOf(x, fanV_);
        ring(x, fanV_, outerRing_);
        for (const std::uint32_t y : outerRing_)
          if (y != centre) offer(x, y, 0);
      }
  }
  void ring(std::uint32_t centre, const std::vector<std::uint32_t>& fan, std::vector<std::uint32_t>& out) {
    ++stamp_;
    out.clear();
    mark_[centre] = stamp_;
    for (const std::uint32_t c : fan)
      for (const std::uint32_t x : patch_.triangles[c / 3])
        if (mark_[x] != stamp_) {
          mark_[x] = stamp_;
          out.push_back(x);
        }
  }

  Patch& patch_;
  std::vector<std::uint8_t>& alive_;
  std::size_t left_ = 0;
  Shape shape_ = kGoodShape;
  std::vector<Vec3> places_;
  std::vector<std::uint32_t> head_, tail_, next_;  ///< corners of a vertex, as lists
  std::vector<std::uint32_t> version_, mark_;
  std::vector<std::uint8_t> waiting_;
  std::uint32_t stamp_ = 0;
  std::vector<Candidate> heap_;
  std::vector<std::uint32_t> fanU_, fanV_, ring_, outerRing_;
  std::vector<WedgeCorner> wedgeCorners_;
  std::vector<std::array<Vec3, 3>> wedgePlaces_;  ///< per wedge corner: those of its triangle
  WedgeCollapse wedges_;
};

}  // namespace

bool collapseEdges(Patch& patch, std::size_t target, std::vector<std::uint8_t>& alive) {
  Collapser collapser(patch, alive);
  return collapser.run(target, kGoodShape) || collapser.run(target, kAnyShape);
}

}  // namespace trimtab::terrain
