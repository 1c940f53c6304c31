#include "borders.h"

#include <cmath>
#include <optional>

#include "trimtab/terrain/scenery/lines.h"
#include "trimtab/terrain/static_lod/error.h"

namespace trimtab::terrain {

namespace {

constexpr int kOutside = -1;
/// A corner that is no deeper inside a circle than this touches it.
constexpr double kTouchM = 0.01;

/// Returns whether the sides of an edge, and what lies beyond it, differ in material.
template <class MaterialOf>
bool isBorder(std::span<const EdgeUse> edge, const MaterialOf& materialOf, int beyond) {
  const int first = materialOf(edge[0]);
  if (edge.size() == 1) return first != beyond;
  return std::any_of(edge.begin() + 1, edge.end(), [&](const EdgeUse& e) { return materialOf(e) != first; });
}

/// Raises `worst` to the largest cost along `line`. The cost of a place is its distance to the nearest
/// segment of `to`, or `vanished(place, distance, worst)` where that is less.
template <class Vanished>
void raise(double& worst, const Segment& line, const SegmentGrid& to, const Vanished& vanished) {
  std::vector<Segment> pieces{line};
  while (!pieces.empty()) {
    const Segment piece = pieces.back();
    pieces.pop_back();
    const Point middle = piece.at(0.5);
    const Segment* nearest = to.nearest(middle);
    const double distance = nearest ? nearest->distance(middle) : INFINITY;
    // The distance to one segment is convex: along the piece it is largest at an end.
    const double most = nearest ? std::max(nearest->distance(piece.a), nearest->distance(piece.b)) : INFINITY;
    if (most <= worst) continue;
    const double cost = vanished(middle, distance, worst);
    if (cost < distance) {
      worst = std::max(worst, cost);
      if (piece.length() <= std::max(0.5, worst / 4)) continue;
    } else if (most - distance <= std::max(0.1, distance / 8)) {
      worst = most;
      continue;
    }
    pieces.push_back({piece.a, middle});
    pieces.push_back({middle, piece.b});
  }
}

}  // namespace

std::vector<std::uint8_t> borderMaterials(const LatticeTile& tile, std::span<const std::string> materials) {
  return std::vector<std::uint8_t>(materials.size(), isAirport(tile.name));
}

BorderMeasure::BorderMeasure(const LatticeTile& tile, const LodTree& tree,
                             std::span<const std::uint8_t> counts)
    : tree_(tree), counts_(counts.begin(), counts.end()), sides_(counts.size()), source_(counts.size()) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const std::uint32_t t : tree.order) {
    triangles.push_back(tile.triangles[t]);
    material_.push_back(tile.material[t]);
  }
  edges_ = sortedEdges(triangles);
  const auto materialOf = [&](const EdgeUse& e) { return int{material_[e.triangle]}; };
  forEachEdge(edges_, [&](std::span<const EdgeUse> edge) {
    if (!isBorder(edge, materialOf, kOutside)) return;
    const Segment line{place(edge[0].low), place(edge[0].high)};
    const double length = line.length();
    if (!(length > 0)) return;
    for (std::size_t i = 0; i < edge.size(); ++i) {
      const std::uint16_t material = material_[edge[i].triangle];
      if (!counts_[material]) continue;
      const Point along = (edge[i].forward ? 1 / length : -1 / length) * (line.b - line.a);
      sides_[material].push_back({line,
                                  {-along.y, along.x},
                                  edge[i].triangle,
                                  edge.size() == 2 ? edge[1 - i].triangle : LodTree::kNone});
      source_[material].add(line);
    }
  });
  for (SegmentGrid& grid : source_) grid.finish();
}

Point BorderMeasure::place(std::uint32_t vertex) const {
  const Vec3 p = tree_.vertices[vertex].metres() - tree_.origin.metres();
  return {p.x, p.y};
}

/// Returns the source's material beyond an edge of the node's border, which no level changes.
int BorderMeasure::outsideOf(const EdgeUse& edge, const LodTree::Node& node) const {
  auto at = std::lower_bound(edges_.begin(), edges_.end(), edge, [](const EdgeUse& a, const EdgeUse& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  for (; at != edges_.end() && at->low == edge.low && at->high == edge.high; ++at)
    if (at->triangle < node.first || at->triangle >= node.last) return material_[at->triangle];
  return kOutside;
}

/// Returns the radius of the largest circle that touches `on`, lies on the side `towards` and holds no border
/// of the material; no more than `mostM`. It stops early at a circle no larger than `enoughM`.
double BorderMeasure::circle(Point on, Point towards, std::size_t material, double mostM,
                             double enoughM) const {
  double radius = std::min(mostM, 1e5);
  for (int i = 0; i < 50 && radius > enoughM; ++i) {
    const Point centre = on + radius * towards;
    const Segment* inside = source_[material].nearest(centre, radius - kTouchM);
    if (!inside) break;
    const Point away = inside->nearest(centre) - on;
    const double height = dot(away, towards);
    if (!(height > 0)) break;
    radius = std::min(radius - kTouchM, dot(away, away) / (2 * height));
  }
  return radius;
}

double BorderMeasure::of(const LodTree::Node& node, double atLeastM) const {
  std::vector<SegmentGrid> drawn(source_.size());
  const std::vector<EdgeUse> edges = sortedEdges(node.triangles);
  const auto materialOf = [&](const EdgeUse& e) { return int{node.material[e.triangle]}; };
  double worst = atLeastM;
  const auto stays = [](Point, double distance, double) { return distance; };
  forEachEdge(edges, [&](std::span<const EdgeUse> edge) {
    const int beyond = edge.size() == 1 ? outsideOf(edge[0], node) : kOutside;
    if (!isBorder(edge, materialOf, beyond)) return;
    const Segment line{place(edge[0].low), place(edge[0].high)};
    if (beyond != kOutside) drawn[static_cast<std::size_t>(beyond)].add(line);
    for (const EdgeUse& e : edge) {
      const std::uint16_t material = node.material[e.triangle];
      if (!counts_[material]) continue;
      drawn[material].add(line);
      if (!source_[material].empty()) raise(worst, line, source_[material], stays);
    }
  });
  for (SegmentGrid& grid : drawn) grid.finish();

  std::optional<VerticalDistance> surface;
  const auto here = [&](std::uint32_t t) { return t >= node.first && t < node.last; };
  for (std::size_t material = 0; material < sides_.size(); ++material)
    for (const Side& side : sides_[material]) {
      if (!here(side.inside) && !here(side.outside)) continue;
      raise(worst, side.line, drawn[material], [&](Point p, double distance, double enough) {
        const auto step = [](double m) {
          return static_cast<std::int32_t>(std::lround(m / Lattice::kStepM));
        };
        if (!surface) surface.emplace(tree_.vertices, node.triangles);
        const auto found = surface->at({tree_.origin.x + step(p.x), tree_.origin.y + step(p.y), 0});
        // If the material is drawn here, what lies beside it has vanished.
        const bool still = found && node.material[*found] == material;
        return circle(p, still ? -1.0 * side.inward : side.inward, material, distance, enough);
      });
    }
  return worst;
}

}  // namespace trimtab::terrain
