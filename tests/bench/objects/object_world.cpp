#include "object_world.h"

#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/objects/build_objects.h"

namespace trimtab::bench {
namespace {

using terrain::SourceMesh;

/// Adds a surface of revolution about z: rings of (radius, height), from the bottom, closed where a radius is
/// 0. `sides` of 4 make a house.
void addTurned(SourceMesh& mesh, const std::vector<std::array<float, 2>>& rings, int sides,
               std::array<std::uint8_t, 4> colour) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [radius, height] : rings)
    for (int i = 0; i < sides; ++i) {
      const auto turn = static_cast<float>(2 * std::numbers::pi * i / sides);
      mesh.vertices.push_back(
          {.position = {radius * std::cos(turn), radius * std::sin(turn), height}, .colour = colour});
    }
  const auto at = [&](std::size_t ring, int i) {
    return first + static_cast<std::uint32_t>(ring) * static_cast<std::uint32_t>(sides) +
           static_cast<std::uint32_t>(i % sides);
  };
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring)
    for (int i = 0; i < sides; ++i)
      for (const std::uint32_t v : {at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring, i),
                                    at(ring + 1, i + 1), at(ring + 1, i)})
        mesh.indices.push_back(v);
}

std::vector<std::optional<terrain::BuiltModel>> models() {
  std::vector<std::optional<terrain::BuiltModel>> all;
  for (int kind = 0; kind < 12; ++kind) {
    const auto k = static_cast<float>(kind % 4);
    terrain::SourceModel model{.name = "model " + std::to_string(kind), .levels = {{}}, .textures = {}};
    SourceMesh& mesh = model.levels[0];
    mesh.bothSides = false;
    if (kind < 4) {
      addTurned(mesh, {{0.4f, 0}, {0.3f, 3}}, 6, {90, 70, 50, 255});
      addTurned(mesh, {{0, 2}, {3 + 0.4f * k, 2.5f}, {2, 7}, {2.3f, 7.5f}, {1, 12}, {0, 14 + k}}, 12,
                {40, 80, 45, 255});
    } else if (kind < 8) {
      addTurned(mesh, {{0.5f, 0}, {0.4f, 4}}, 6, {90, 70, 50, 255});
      addTurned(mesh, {{0, 3}, {3, 4}, {4.5f + 0.3f * k, 7}, {4, 10}, {2, 12.5f}, {0, 13}}, 14,
                {70, 100, 50, 255});
    } else if (kind < 11) {
      addTurned(mesh, {{0, 0}, {6, 0}, {6 + k, 5}, {0, 9}}, 4, {180, 160, 140, 255});
      addTurned(mesh, {{0, 8}, {0.7f, 8}, {0.7f, 10}, {0, 10}}, 6, {120, 60, 50, 255});
    } else {
      addTurned(mesh, {{0, 0}, {2, 0}, {0.5f, 25}, {4, 27}, {0.3f, 28}, {0, 45}}, 8, {130, 130, 140, 255});
    }
    auto built = terrain::buildModel(model);
    if (built)
      all.emplace_back(std::move(built).value());
    else
      all.emplace_back();
  }
  return all;
}

ListedPlacement placedAt(GeodeticPosition place, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  ListedPlacement p;
  p.latitude = place.latitude;
  p.longitude = place.longitude;
  p.heading = Degrees{180 * unit(random)};
  p.scale = 1 + 0.3 * unit(random);
  return p;
}

std::shared_ptr<const terrain::ObjectTerrain> built(const PlacementList& list,
                                                    const terrain::Database& ground) {
  auto objects =
      terrain::buildObjects(models(), list, ground, ground.patches()->index().frame, "scattered objects");
  if (!objects) {
    std::cerr << toString(objects.findings());
    return nullptr;
  }
  return std::make_shared<const terrain::ObjectTerrain>(std::move(objects).value());
}

/// A list without placements of the twelve models.
PlacementList emptyList() {
  PlacementList list;
  for (int i = 0; i < 12; ++i) list.models.push_back(std::to_string(i));
  return list;
}

GeodeticPosition middleOf(const terrain::TerrainInfo& info) {
  return {Degrees{0.5 * (info.southWest.latitude.value() + info.northEast.latitude.value())},
          Degrees{0.5 * (info.southWest.longitude.value() + info.northEast.longitude.value())}, Metres{0}};
}

}  // namespace

std::shared_ptr<const terrain::ObjectTerrain> treesOnForest(const terrain::Database& ground, int count,
                                                            double radiusKm) {
  const auto scenery = ground.staticLod();
  if (!scenery) return nullptr;
  const StaticLodIndex& index = scenery->index;
  const Vec3 middle = index.frame.fromGeodetic(middleOf(ground.info()));
  struct Triangle {
    std::array<Vec3, 3> corners;
  };
  std::vector<Triangle> forest;
  std::vector<double> areas;
  for (std::size_t node = 0; node < index.size(); ++node) {
    if (index.nodes[node].children[0] != StaticLodIndex::kNone) continue;
    const terrain::StaticLodTile& tile = scenery->tiles[index.nodes[node].tile];
    const terrain::StaticLodRange range = scenery->ranges[node];
    for (std::uint32_t t = range.firstTriangle; t < range.firstTriangle + range.triangles; ++t) {
      if (scenery->materials[tile.material[t]].find("Forest") == std::string::npos) continue;
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) {
        const terrain::StaticLodVertex& v = tile.vertices[tile.indices[3 * t + i]];
        triangle.corners[i] =
            Vec3{16.0 * tile.origin[0] + v.x, 16.0 * tile.origin[1] + v.y, 16.0 * tile.origin[2] + v.z};
      }
      const auto& [a, b, c] = triangle.corners;
      if (std::hypot(a.x - middle.x, a.y - middle.y) > 1000 * radiusKm) continue;
      areas.push_back(length(cross(b - a, c - a)));
      forest.push_back(triangle);
    }
  }
  if (forest.empty()) return nullptr;
  std::mt19937 random(19);
  std::discrete_distribution<std::size_t> chosen(areas.begin(), areas.end());
  std::uniform_real_distribution<double> unit(0, 1);
  PlacementList list = emptyList();
  while (list.placements.size() < static_cast<std::size_t>(count)) {
    const auto& [a, b, c] = forest[chosen(random)].corners;
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    ListedPlacement p = placedAt(index.frame.toGeodetic(a + u * (b - a) + v * (c - a)), random);
    p.model = static_cast<std::uint32_t>(random() % 8);
    if (ground.heightAt(p.latitude, p.longitude)) list.placements.push_back(p);
  }
  return built(list, ground);
}

std::shared_ptr<const terrain::ObjectTerrain> scatteredOver(const terrain::Database& ground, int count,
                                                            double radiusKm) {
  const GeodeticPosition middle = middleOf(ground.info());
  const double kmOfDegree = 111 * std::cos(middle.latitude.value() * std::numbers::pi / 180);
  std::mt19937 random(19);
  std::uniform_real_distribution<double> unit(-1, 1);
  PlacementList list = emptyList();
  while (list.placements.size() < static_cast<std::size_t>(count)) {
    const double north = unit(random), east = unit(random);
    ListedPlacement p = placedAt({middle.latitude + Degrees{north * radiusKm / 111},
                                  middle.longitude + Degrees{east * radiusKm / kmOfDegree}, Metres{0}},
                                 random);
    p.model = static_cast<std::uint32_t>(random() % 40);
    // Most are trees; one in forty is a mast.
    p.model = p.model < 36 ? p.model % 8 : p.model - 28;
    const auto height = ground.heightAt(p.latitude, p.longitude);
    if (height && height->value() > 1) list.placements.push_back(p);
  }
  return built(list, ground);
}

}  // namespace trimtab::bench
