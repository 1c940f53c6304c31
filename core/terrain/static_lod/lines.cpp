#include "lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "edges.h"
#include "trimtab/terrain/scenery/lines.h"

namespace trimtab::terrain {

namespace {

constexpr double kWide = std::numeric_limits<double>::infinity();

struct Side {
  std::uint32_t a, b;         ///< vertices
  std::uint32_t left, right;  ///< triangles
};

/// Returns the edges that two triangles share.
std::vector<Side> sidesOf(const LatticeTile& tile) {
  std::vector<Side> sides;
  forEachEdge(sortedEdges(tile.triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) sides.push_back({edge[0].low, edge[0].high, edge[0].triangle, edge[1].triangle});
  });
  return sides;
}

/// Connected triangles of one kind, and how wide they are.
class Features {
 public:
  explicit Features(const LatticeTile& tile) : parent_(tile.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const auto& t : tile.triangles)
      area_.push_back(std::abs(static_cast<double>(
                          orientation(tile.vertices[t[0]], tile.vertices[t[1]], tile.vertices[t[2]]))) *
                      0.5 * Lattice::kStepM * Lattice::kStepM);
    border_.assign(area_.size(), 0);
  }
  void join(std::uint32_t s, std::uint32_t t) {
    s = root(s), t = root(t);
    if (s == t) return;
    parent_[t] = s;
    area_[s] += area_[t];
    border_[s] += border_[t];
  }
  void addBorder(std::uint32_t t, double metres) { border_[root(t)] += metres; }
  double widthM(std::uint32_t t) {
    t = root(t);
    return border_[t] > 0 ? 2 * area_[t] / border_[t] : kWide;
  }

 private:
  std::uint32_t root(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }
  std::vector<std::uint32_t> parent_;
  std::vector<double> area_, border_;
};

double flatLengthM(const Lattice& a, const Lattice& b) {
  return std::hypot(static_cast<double>(a.x) - b.x, static_cast<double>(a.y) - b.y) * Lattice::kStepM;
}

/// Returns how far a place is from the stretch between two others, from above.
double awayM(const Lattice& p, const Lattice& a, const Lattice& b) {
  const double x = static_cast<double>(b.x) - a.x, y = static_cast<double>(b.y) - a.y;
  const double px = static_cast<double>(p.x) - a.x, py = static_cast<double>(p.y) - a.y;
  const double squared = x * x + y * y;
  const double t = squared > 0 ? std::clamp((px * x + py * y) / squared, 0.0, 1.0) : 0;
  return std::hypot(px - t * x, py - t * y) * Lattice::kStepM;
}

/// Detail by repeated halving (Douglas and Peucker): a vertex has no more than the one that halved its
/// stretch.
void addDetail(const LatticeTile& tile, const std::vector<std::uint32_t>& line, std::vector<double>& detail) {
  struct Stretch {
    std::size_t first, last;
    double most;
  };
  std::vector<Stretch> stack{{0, line.size() - 1, kWide}};
  while (!stack.empty()) {
    const Stretch s = stack.back();
    stack.pop_back();
    double most = -1;
    std::size_t at = s.first;
    for (std::size_t i = s.first + 1; i < s.last; ++i) {
      const double away =
          awayM(tile.vertices[line[i]], tile.vertices[line[s.first]], tile.vertices[line[s.last]]);
      if (away > most) most = away, at = i;
    }
    if (at == s.first) continue;
    most = std::min(most, s.most);
    detail[line[at]] = std::max(detail[line[at]], most);
    stack.push_back({s.first, at, most});
    stack.push_back({at, s.last, most});
  }
}

/// Detail of every vertex on a shoreline; ends and meeting points stay whatever the size.
std::vector<double> shoreDetail(const LatticeTile& tile, const std::vector<Side>& shores) {
  struct Next {
    std::uint32_t from, to, edge;
  };
  std::vector<Next> links;
  for (std::uint32_t i = 0; i < shores.size(); ++i) {
    links.push_back({shores[i].a, shores[i].b, i});
    links.push_back({shores[i].b, shores[i].a, i});
  }
  std::sort(links.begin(), links.end(),
            [](const Next& a, const Next& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  const auto linksOf = [&](std::uint32_t v) {
    const auto low = std::lower_bound(links.begin(), links.end(), v,
                                      [](const Next& link, std::uint32_t from) { return link.from < from; });
    auto high = low;
    while (high != links.end() && high->from == v) ++high;
    return std::span<const Next>(low, high);
  };
  std::vector<double> detail(tile.vertices.size(), 0);
  std::vector<std::uint8_t> walked(shores.size());
  const auto walk = [&](std::uint32_t start, const Next& first) {
    std::vector<std::uint32_t> line{start, first.to};
    walked[first.edge] = 1;
    while (line.back() != start) {
      const auto onward = linksOf(line.back());
      if (onward.size() != 2) break;
      const Next& next = walked[onward[0].edge] ? onward[1] : onward[0];
      if (walked[next.edge]) break;
      walked[next.edge] = 1;
      line.push_back(next.to);
    }
    return line;
  };
  for (const Next& link : links) {
    if (linksOf(link.from).size() == 2) continue;
    detail[link.from] = kWide;
    if (!walked[link.edge]) addDetail(tile, walk(link.from, link), detail);
  }
  for (const Next& link : links) {  // what is left are rings
    if (walked[link.edge]) continue;
    std::vector<std::uint32_t> ring = walk(link.from, link);
    detail[link.from] = kWide;
    std::size_t far = 0;
    double farthest = -1;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const double away = flatLengthM(tile.vertices[ring[i]], tile.vertices[ring[0]]);
      if (away > farthest) farthest = away, far = i;
    }
    if (far == 0) continue;
    detail[ring[far]] = kWide;
    const auto middle = ring.begin() + static_cast<std::ptrdiff_t>(far);
    addDetail(tile, {ring.begin(), middle + 1}, detail);
    addDetail(tile, {middle, ring.end()}, detail);
  }
  return detail;
}

}  // namespace

std::vector<float> lineWidths(const LatticeTile& tile, std::span<const std::string> materials) {
  std::vector<float> widths(tile.vertices.size(), 0);
  if (isAirport(tile.name)) return widths;  // its asphalt is no road
  std::vector<std::uint8_t> line, water;
  for (const std::string& material : materials) {
    line.push_back(lineFeatureOf(material) != LineFeature::none);
    water.push_back(isWater(material));
  }
  const std::vector<Side> sides = sidesOf(tile);
  Features lines(tile), bodies(tile);
  std::vector<Side> shores;
  for (const Side& s : sides) {
    const std::uint16_t left = tile.material[s.left], right = tile.material[s.right];
    if (left == right && line[left]) lines.join(s.left, s.right);
    if (water[left] == water[right])
      bodies.join(s.left, s.right);
    else
      shores.push_back(s);
  }
  for (const Side& s : sides) {
    const std::uint16_t left = tile.material[s.left], right = tile.material[s.right];
    const double length = flatLengthM(tile.vertices[s.a], tile.vertices[s.b]);
    if (line[left] != line[right]) lines.addBorder(line[left] ? s.left : s.right, length);
    if (water[left] != water[right]) {
      bodies.addBorder(s.left, length);
      bodies.addBorder(s.right, length);
    }
  }
  const auto widen = [&](std::uint32_t v, double metres) {
    widths[v] = std::max(widths[v], static_cast<float>(metres));
  };
  for (std::uint32_t t = 0; t < tile.triangles.size(); ++t)
    if (line[tile.material[t]])
      for (const std::uint32_t v : tile.triangles[t]) widen(v, lines.widthM(t));
  const std::vector<double> detail = shoreDetail(tile, shores);
  for (const Side& s : shores) {
    const double body = std::min(bodies.widthM(s.left), bodies.widthM(s.right));
    widen(s.a, std::min(body, detail[s.a]));
    widen(s.b, std::min(body, detail[s.b]));
  }
  return widths;
}

}  // namespace trimtab::terrain
