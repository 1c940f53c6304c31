#include "texture.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

/// Twice the area over the longest edge squared: below it a triangle says nothing about its map.
constexpr double kThinnest = 1e-3;

TexturePlace textureAt(const LatticeTile& tile, std::uint32_t triangle, std::uint32_t vertex) {
  const auto& t = tile.triangles[triangle];
  const auto k = static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
  return tile.texture[triangle][k];
}

double twiceAreaFromAbove(const std::array<Vec3, 3>& p) {
  return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
}

/// Weighted sums of linear functions (x, y, 1), and of their products.
struct WedgeSums {
  TexturePlace at{};
  double weight = 0, gradient = 0;
  std::array<Vec3, 2> sum{};
  Quadric products;  ///< in x, y and, for 1, the terms bx, by and c

  void add(const TextureMap& map, double w) {
    weight += w;
    for (std::size_t k = 0; k < 2; ++k) {
      const double x = map.x[k], y = map.y[k], d = map.at0[k];
      gradient += w * (x * x + y * y);
      sum[k] = sum[k] + Vec3{w * x, w * y, w * d};
      products += Quadric{w * x * x, w * x * y, 0, w * y * y, 0, 0, w * x * d, w * y * d, 0, w * d * d};
    }
  }
  /// Returns the variance as square metres, times `scale` and the weight.
  Quadric variance(double scale) const {
    Quadric q = products;
    for (const Vec3& s : sum)
      q -= Quadric{s.x * s.x / weight, s.x * s.y / weight, 0, s.y * s.y / weight, 0, 0,
                   s.x * s.z / weight, s.y * s.z / weight, 0, s.z * s.z / weight};
    const double k = gradient > 0 ? scale * weight / gradient : 0;
    return {q.xx * k, q.xy * k, 0, q.yy * k, 0, 0, q.bx * k, q.by * k, 0, q.c * k};
  }
};

}  // namespace

std::optional<TextureMap> textureMapOf(const std::array<Vec3, 3>& places, const TextureCorners& texture) {
  const double ax = places[1].x - places[0].x, ay = places[1].y - places[0].y;
  const double bx = places[2].x - places[0].x, by = places[2].y - places[0].y;
  const double twice = twiceAreaFromAbove(places);
  const double longest =
      std::max({ax * ax + ay * ay, bx * bx + by * by, (ax - bx) * (ax - bx) + (ay - by) * (ay - by)});
  if (!(twice > kThinnest * longest)) return std::nullopt;
  TextureMap map;
  for (std::size_t k = 0; k < 2; ++k) {
    const double a = double{texture[1][k]} - texture[0][k], b = double{texture[2][k]} - texture[0][k];
    map.x[k] = (a * by - b * ay) / twice;
    map.y[k] = (b * ax - a * bx) / twice;
    map.at0[k] = texture[0][k] - map.x[k] * places[0].x - map.y[k] * places[0].y;
  }
  return map;
}

bool isSeam(const LatticeTile& tile, const EdgeUse& a, const EdgeUse& b) {
  if (tile.texture.empty()) return false;
  for (const std::uint32_t v : {a.low, a.high})
    if (textureAt(tile, a.triangle, v) != textureAt(tile, b.triangle, v)) return true;
  return false;
}

void addTextureQuadrics(const LatticeTile& tile, const Lattice& origin, double weight,
                        std::span<Quadric> quadrics) {
  if (tile.texture.empty()) return;
  std::vector<std::vector<WedgeSums>> wedges(tile.vertices.size());
  for (std::size_t t = 0; t < tile.triangles.size(); ++t) {
    std::array<Vec3, 3> places;
    for (std::size_t k = 0; k < 3; ++k)
      places[k] = tile.vertices[tile.triangles[t][k]].metres() - origin.metres();
    const auto map = textureMapOf(places, tile.texture[t]);
    if (!map) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      auto& of = wedges[tile.triangles[t][k]];
      const auto same = [&](const WedgeSums& w) { return w.at == tile.texture[t][k]; };
      auto found = std::find_if(of.begin(), of.end(), same);
      if (found == of.end()) {
        of.emplace_back();
        found = of.end() - 1;
        found->at = tile.texture[t][k];
      }
      found->add(*map, twiceAreaFromAbove(places) / 6);
    }
  }
  for (std::size_t v = 0; v < wedges.size(); ++v)
    for (const WedgeSums& wedge : wedges[v]) quadrics[v] += wedge.variance(weight);
}

std::uint32_t WedgeCollapse::rootOf(std::uint32_t wedge) const {
  while (wedges_[wedge].parent != wedge) wedge = wedges_[wedge].parent;
  return wedge;
}

void WedgeCollapse::run(std::span<const WedgeCorner> corners, std::optional<bool> end, Vec3 place,
                        std::span<const std::array<Vec3, 3>> places, std::vector<TextureCorners>& texture) {
  wedges_.clear();
  wedgeOf_.clear();
  for (const WedgeCorner& c : corners) {
    const TexturePlace at = texture[c.corner / 3][c.corner % 3];
    std::uint32_t i = 0;
    while (i < wedges_.size() && !(wedges_[i].second == c.second && wedges_[i].at == at)) ++i;
    if (i == wedges_.size()) wedges_.push_back({c.second, at, i});
    wedgeOf_.push_back(i);
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      if (corners[i].goes && corners[j].goes && corners[i].corner / 3 == corners[j].corner / 3) {
        const std::uint32_t a = rootOf(wedgeOf_[i]), b = rootOf(wedgeOf_[j]);
        wedges_[std::max(a, b)].parent = std::min(a, b);
      }

  struct New {
    double weight = 0;
    std::array<double, 2> sum{};
    std::optional<TexturePlace> ofEnd;
  };
  std::vector<New> fresh(wedges_.size());
  for (std::uint32_t i = 0; i < wedges_.size(); ++i)
    if (New& of = fresh[rootOf(i)]; end && wedges_[i].second == *end && !of.ofEnd) of.ofEnd = wedges_[i].at;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto map = textureMapOf(places[i], texture[corners[i].corner / 3]);
    if (!map) continue;
    New& of = fresh[rootOf(wedgeOf_[i])];
    const double area = twiceAreaFromAbove(places[i]), w = area * area;
    const auto at = map->at(place.x, place.y);
    of.weight += w;
    for (std::size_t k = 0; k < 2; ++k) of.sum[k] += w * at[k];
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const WedgeCorner& c = corners[i];
    if (c.goes || (end && c.second == *end)) continue;
    const New& of = fresh[rootOf(wedgeOf_[i])];
    TexturePlace& at = texture[c.corner / 3][c.corner % 3];
    if (of.ofEnd)
      at = *of.ofEnd;
    else if (of.weight > 0)
      at = {static_cast<float>(of.sum[0] / of.weight), static_cast<float>(of.sum[1] / of.weight)};
    else
      at = wedges_[rootOf(wedgeOf_[i])].at;
  }
}

}  // namespace trimtab::terrain
