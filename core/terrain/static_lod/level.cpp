#include "trimtab/terrain/static_lod/level.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "edges.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/scenery/lines.h"
#include "trimtab/terrain/static_lod/error.h"

namespace trimtab::terrain {

namespace {

Lattice placeOf(const StaticLodTile& tile, const StaticLodVertex& v) {
  const auto step = [](std::int32_t origin, float metres) {
    return origin * 4096 + static_cast<std::int32_t>(std::lround(double{metres} * 256));
  };
  return {step(tile.origin[0], v.x), step(tile.origin[1], v.y), step(tile.origin[2], v.z)};
}

template <class Visit>
void forEachNode(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level, const Visit& visit) {
  for (std::uint32_t i = 0; i < terrain.index.size(); ++i) {
    const StaticLodIndex::Node& node = terrain.index.nodes[i];
    const bool leaf = node.children[0] == StaticLodIndex::kNone;
    if (node.tile == tile && (node.depth == level || (leaf && node.depth < level))) visit(i);
  }
}

Lattice middleOf(const LatticeSurface& surface, std::uint32_t triangle) {
  std::int64_t x = 0, y = 0;
  for (const std::uint32_t v : surface.triangles[triangle])
    x += surface.vertices[v].x, y += surface.vertices[v].y;
  return {static_cast<std::int32_t>(x / 3), static_cast<std::int32_t>(y / 3), 0};
}

/// An edge of the source between a line and what is none, or between water and land.
struct Border {
  double metres;
  bool shore;
  std::uint32_t inside, outside;  ///< triangles; of a shore: water and land
};

std::vector<Border> bordersOf(const LatticeSurface& source, const std::vector<std::uint8_t>& line,
                              const std::vector<std::uint8_t>& water) {
  std::vector<Border> borders;
  const std::vector<EdgeUse> edges = sortedEdges(source.triangles);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const EdgeUse &s = edges[i], &t = edges[i + 1];
    if (s.low != t.low || s.high != t.high) continue;
    const Lattice &p = source.vertices[s.low], &q = source.vertices[s.high];
    const double metres =
        std::hypot(static_cast<double>(p.x) - q.x, static_cast<double>(p.y) - q.y) * Lattice::kStepM;
    const std::uint16_t left = source.material[s.triangle], right = source.material[t.triangle];
    if (line[left] != line[right])
      borders.push_back(
          {metres, false, line[left] ? s.triangle : t.triangle, line[left] ? t.triangle : s.triangle});
    if (water[left] != water[right])
      borders.push_back(
          {metres, true, water[left] ? s.triangle : t.triangle, water[left] ? t.triangle : s.triangle});
  }
  return borders;
}

}  // namespace

std::vector<std::uint32_t> nodesOfLevel(const StaticLodTerrain& terrain, std::size_t tile,
                                        std::uint32_t level) {
  std::vector<std::uint32_t> nodes;
  forEachNode(terrain, tile, level, [&](std::uint32_t node) { nodes.push_back(node); });
  return nodes;
}

LatticeSurface surfaceOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level) {
  const StaticLodTile& from = terrain.tiles[tile];
  LatticeSurface surface;
  std::map<Lattice, std::uint32_t> numbers;
  forEachNode(terrain, tile, level, [&](std::uint32_t node) {
    const StaticLodRange range = terrain.ranges[node];
    for (std::uint32_t t = range.firstTriangle; t < range.firstTriangle + range.triangles; ++t) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Lattice p = placeOf(from, from.vertices[from.indices[std::size_t{t} * 3 + k]]);
        const auto [at, isNew] = numbers.try_emplace(p, static_cast<std::uint32_t>(surface.vertices.size()));
        if (isNew) surface.vertices.push_back(p);
        corners[k] = at->second;
      }
      surface.triangles.push_back(corners);
      surface.material.push_back(from.material[t]);
    }
  });
  return surface;
}

std::uint32_t levelsOf(const StaticLodTerrain& terrain, std::size_t tile) {
  std::uint32_t levels = 0;
  for (const StaticLodIndex::Node& node : terrain.index.nodes)
    if (node.tile == tile) levels = std::max<std::uint32_t>(levels, node.depth + 1u);
  return levels;
}

std::uint64_t bytesOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level) {
  std::vector<std::uint32_t> used;
  std::uint64_t bytes = 0;
  forEachNode(terrain, tile, level, [&](std::uint32_t node) {
    const StaticLodRange range = terrain.ranges[node];
    const auto first =
        terrain.tiles[tile].indices.begin() + static_cast<std::ptrdiff_t>(range.firstTriangle) * 3;
    used.insert(used.end(), first, first + static_cast<std::ptrdiff_t>(range.triangles) * 3);
    bytes += std::uint64_t{range.triangles} * 3 * sizeof(std::uint32_t);
  });
  std::sort(used.begin(), used.end());
  const auto vertices = std::unique(used.begin(), used.end()) - used.begin();
  return bytes + static_cast<std::uint64_t>(vertices) * sizeof(StaticLodVertex);
}

SceneryMesh sourceOf(const StaticLodTerrain& terrain, std::size_t tile) {
  LatticeSurface source = surfaceOfLevel(terrain, tile, 0xffffffffu);
  SceneryMesh mesh;
  mesh.name = terrain.tiles[tile].name;
  mesh.airport = isAirport(mesh.name);
  mesh.materials = terrain.materials;
  for (const Lattice& p : source.vertices) mesh.vertices.push_back(terrain.index.frame.toEcef(p.metres()));
  for (std::size_t t = 0; t < source.triangles.size(); ++t)
    mesh.triangles.push_back({source.triangles[t], source.material[t]});
  mesh.trianglesInFile = mesh.triangles.size();
  return mesh;
}

std::vector<LineShare> lineShares(const StaticLodTerrain& terrain, std::size_t tile) {
  std::vector<std::uint8_t> line, water;
  for (const std::string& material : terrain.materials) {
    line.push_back(lineFeatureOf(material) != LineFeature::none);
    water.push_back(isWater(material));
  }
  const std::uint32_t levels = levelsOf(terrain, tile);
  const LatticeSurface source = surfaceOfLevel(terrain, tile, levels - 1);
  const std::vector<Border> borders = bordersOf(source, line, water);
  std::vector<LineShare> shares(levels);
  for (std::uint32_t level = 0; level < levels; ++level) {
    const LatticeSurface surface = surfaceOfLevel(terrain, tile, level);
    const VerticalDistance over(surface.vertices, surface.triangles);
    const auto shows = [&](std::uint32_t triangle, const std::vector<std::uint8_t>& kind, bool wanted) {
      const auto found = over.at(middleOf(source, triangle));
      return found && (kind[surface.material[*found]] != 0) == wanted;
    };
    LineShare& share = shares[level];
    for (const Border& b : borders) {
      const bool left =
          shows(b.inside, b.shore ? water : line, true) && (!b.shore || shows(b.outside, water, false));
      (b.shore ? share.shoreM : share.lineM) += b.metres;
      if (left) (b.shore ? share.shoreLeftM : share.lineLeftM) += b.metres;
    }
  }
  return shares;
}

}  // namespace trimtab::terrain
