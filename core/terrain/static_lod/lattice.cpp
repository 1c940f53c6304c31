#include "trimtab/terrain/static_lod/lattice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "edges.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

constexpr double kReachM = 1.0e6;       ///< of the frame's origin: up is within 10 degrees of the frame's
constexpr double kTileReachM = 60.0e3;  ///< of a tile's middle: a float counts 2^24 steps
constexpr std::uint32_t kNone = 0xffffffffu;

struct LatticeHash {
  std::size_t operator()(const Lattice& p) const {
    std::uint64_t h = static_cast<std::uint32_t>(p.x) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 29) ^ static_cast<std::uint32_t>(p.y)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 32) ^ static_cast<std::uint32_t>(p.z)) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }
};

/// Returns everything wrong with one mesh; empty if it can be used.
Findings faultsOf(const SceneryMesh& mesh, const LocalFrame& frame) {
  Findings findings;
  const auto fault = [&](const std::string& key, const std::string& expected, const std::string& found) {
    if (findings.size() < 8) findings.push_back({Severity::error, mesh.name, key, expected, found});
  };
  Vec3 low{INFINITY, INFINITY, INFINITY}, high = -low;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 v = mesh.vertices[i];
    const Vec3 p = frame.fromEcef(v);
    const std::string key = "vertex " + std::to_string(i);
    const std::string found = numberText(v.x, 9) + " " + numberText(v.y, 9) + " " + numberText(v.z, 9);
    if (!(length(p) <= kReachM)) {
      fault(key, "a place within 1000 km of the terrain's middle", found);
      continue;
    }
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  if (const Vec3 size = high - low; std::max({size.x, size.y, size.z}) > 2 * kTileReachM)
    fault("", "a tile of at most 120 km", numberText(std::max({size.x, size.y, size.z}) / 1000, 4) + " km");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t].vertex)
      if (v >= mesh.vertices.size())
        fault("triangle " + std::to_string(t), "vertices below " + std::to_string(mesh.vertices.size()),
              std::to_string(v));
    if (mesh.triangles[t].material >= mesh.materials.size())
      fault("triangle " + std::to_string(t), "materials below " + std::to_string(mesh.materials.size()),
            std::to_string(mesh.triangles[t].material));
  }
  if (!mesh.texture.empty() && mesh.texture.size() != mesh.triangles.size())
    fault("texture", std::to_string(mesh.triangles.size()) + " triangles",
          std::to_string(mesh.texture.size()));
  return findings;
}

Lattice rounded(Vec3 p) {
  const auto step = [](double v) { return static_cast<std::int32_t>(std::lround(v / Lattice::kStepM)); };
  return {step(p.x), step(p.y), step(p.z)};
}

std::vector<Lattice> positionsOf(const SceneryMesh& mesh, const LocalFrame& frame) {
  std::vector<Lattice> positions;
  positions.reserve(mesh.vertices.size());
  for (const Vec3 v : mesh.vertices) positions.push_back(rounded(frame.fromEcef(v)));
  return positions;
}

/// Gives vertices of one place one number, drops triangles that this or the file made degenerate, and those
/// that say the same again.
void weldTile(LatticeTile& tile, LatticeTiles& counts) {
  weld(tile.vertices, tile.triangles);
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> turned;  // smallest corner first
  for (std::uint32_t i = 0; i < tile.triangles.size(); ++i) {
    std::array<std::uint32_t, 3> t = tile.triangles[i];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    turned.push_back({t, i});
  }
  std::sort(turned.begin(), turned.end());
  std::vector<std::uint8_t> drop(tile.triangles.size());
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const auto& t = turned[i].first;
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      drop[turned[i].second] = 1;
      ++counts.degenerate;
    } else if (i > 0 && turned[i - 1].first == t) {
      drop[turned[i].second] = 1;
      ++counts.repeated;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < drop.size(); ++i)
    if (!drop[i]) {
      tile.triangles[kept] = tile.triangles[i];
      if (!tile.texture.empty()) tile.texture[kept] = tile.texture[i];
      tile.material[kept++] = tile.material[i];
    }
  tile.triangles.resize(kept);
  tile.material.resize(kept);
  if (!tile.texture.empty()) tile.texture.resize(kept);
}

/// Returns one entry for each vertex: it ends an edge that one triangle alone uses, or more than two.
std::vector<std::uint8_t> openVertices(const LatticeTile& tile) {
  std::vector<std::uint8_t> open(tile.vertices.size());
  forEachEdge(sortedEdges(tile.triangles), [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 2) open[edge[0].low] = open[edge[0].high] = 1;
  });
  return open;
}

/// Places of open vertices of all tiles, in a grid of cells of kJoinM.
class SharedPlaces {
 public:
  struct Place {
    Lattice at;
    std::uint32_t tiles = 0;
    Vec3 normal;
  };

  /// Returns the nearest place within kJoinM; a new one if there is none.
  const Place& near(const Lattice& p) {
    constexpr std::int64_t kReach = static_cast<std::int64_t>(kJoinM / Lattice::kStepM);
    std::int64_t nearest = kReach * kReach + 1;
    std::uint32_t found = kNone;
    const Lattice c = cell(p);
    for (std::int32_t dx = -1; dx <= 1; ++dx)
      for (std::int32_t dy = -1; dy <= 1; ++dy)
        for (std::int32_t dz = -1; dz <= 1; ++dz)
          for (std::uint32_t i = firstIn({c.x + dx, c.y + dy, c.z + dz}); i != kNone; i = next_[i]) {
            const std::int64_t x = p.x - places_[i].at.x, y = p.y - places_[i].at.y,
                               z = p.z - places_[i].at.z;
            const std::int64_t squared = x * x + y * y + z * z;
            if (squared < nearest || (squared == nearest && i < found)) nearest = squared, found = i;
          }
    if (found == kNone) {
      found = static_cast<std::uint32_t>(places_.size());
      places_.push_back({p, 0, {}});
      const auto [at, isNew] = cells_.try_emplace(c, kNone);
      next_.push_back(at->second);
      at->second = found;
    }
    return places_[found];
  }
  /// Returns the place exactly there; null if there is none.
  Place* at(const Lattice& p) {
    for (std::uint32_t i = firstIn(cell(p)); i != kNone; i = next_[i])
      if (places_[i].at == p) return &places_[i];
    return nullptr;
  }

 private:
  static Lattice cell(const Lattice& p) {
    constexpr std::int32_t kCell = static_cast<std::int32_t>(kJoinM / Lattice::kStepM) + 1;
    const auto down = [](std::int32_t v) { return v >= 0 ? v / kCell : -((kCell - 1 - v) / kCell); };
    return {down(p.x), down(p.y), down(p.z)};
  }
  std::uint32_t firstIn(const Lattice& c) const {
    const auto found = cells_.find(c);
    return found == cells_.end() ? kNone : found->second;
  }
  std::vector<Place> places_;
  std::vector<std::uint32_t> next_;
  std::unordered_map<Lattice, std::uint32_t, LatticeHash> cells_;
};

void addNormals(LatticeTile& tile) {
  tile.normals.assign(tile.vertices.size(), {});
  for (const auto& t : tile.triangles) {
    const Vec3 a = tile.vertices[t[0]].metres();
    const Vec3 n = cross(tile.vertices[t[1]].metres() - a, tile.vertices[t[2]].metres() - a);
    for (const std::uint32_t v : t) tile.normals[v] = tile.normals[v] + n;
  }
}

}  // namespace

void weld(std::vector<Lattice>& vertices, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::unordered_map<Lattice, std::uint32_t, LatticeHash> number;
  number.reserve(vertices.size());
  std::vector<Lattice> welded;
  for (auto& t : triangles)
    for (std::uint32_t& v : t) {
      const auto [found, isNew] = number.try_emplace(vertices[v], static_cast<std::uint32_t>(welded.size()));
      if (isNew) welded.push_back(vertices[v]);
      v = found->second;
    }
  vertices = std::move(welded);
}

double slopeOf(const Lattice& a, const Lattice& b, const Lattice& c) {
  const Vec3 n = cross(b.metres() - a.metres(), c.metres() - a.metres());
  if (!(n.z > 0)) return kVerticalSlope;
  return std::min(kVerticalSlope, std::hypot(n.x, n.y) / n.z);
}

Result<LatticeTiles> toLattice(std::span<const SceneryMesh> meshes, const LocalFrame& frame) {
  Findings findings;
  for (const SceneryMesh& mesh : meshes)
    for (Finding& f : faultsOf(mesh, frame)) findings.push_back(std::move(f));
  if (!findings.empty()) return findings;

  LatticeTiles all;
  std::map<std::string, std::size_t> materials;
  SharedPlaces places;
  for (const SceneryMesh& mesh : meshes) {
    LatticeTile tile;
    tile.name = mesh.name;
    tile.vertices = positionsOf(mesh, frame);
    tile.texture = mesh.texture;
    for (const SceneryMesh::Triangle& t : mesh.triangles) {
      const std::string& name = mesh.materials[t.material];
      const auto [found, isNew] = materials.try_emplace(name, materials.size());
      if (isNew) all.materials.push_back(name);
      tile.triangles.push_back(t.vertex);
      tile.material.push_back(static_cast<std::uint16_t>(found->second));
    }
    if (materials.size() > 0xffff)
      return Finding{Severity::error, mesh.name, "materials", "at most 65535",
                     std::to_string(materials.size())};
    weldTile(tile, all);
    if (tile.triangles.empty()) {
      findings.push_back({Severity::warning, mesh.name, "triangles", "at least one", "none"});
      continue;
    }
    const std::vector<std::uint8_t> open = openVertices(tile);
    for (std::size_t i = 0; i < open.size(); ++i)
      if (open[i]) tile.vertices[i] = places.near(tile.vertices[i]).at;
    weldTile(tile, all);
    if (!tile.triangles.empty()) all.tiles.push_back(std::move(tile));
  }
  if (all.tiles.empty()) {
    findings.push_back(
        {Severity::error, "static levels of detail", "tiles", "at least one with a triangle", "none"});
    return findings;
  }

  for (LatticeTile& tile : all.tiles) {
    addNormals(tile);
    for (std::size_t i = 0; i < tile.vertices.size(); ++i)
      if (SharedPlaces::Place* place = places.at(tile.vertices[i])) {
        place->normal = place->normal + tile.normals[i];
        ++place->tiles;
      }
  }
  for (LatticeTile& tile : all.tiles) {
    tile.shared.assign(tile.vertices.size(), 0);
    for (std::size_t i = 0; i < tile.vertices.size(); ++i)
      if (const SharedPlaces::Place* place = places.at(tile.vertices[i]); place && place->tiles > 1) {
        tile.shared[i] = 1;
        tile.normals[i] = place->normal;
        ++all.joined;
      }
  }
  return Result<LatticeTiles>(std::move(all), std::move(findings));
}

}  // namespace trimtab::terrain
