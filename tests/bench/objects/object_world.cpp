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

}  // namespace

std::shared_ptr<const terrain::ObjectTerrain> scatteredOver(const terrain::Database& ground, int count,
                                                            double radiusKm) {
  const terrain::TerrainInfo& info = ground.info();
  const double latitude = 0.5 * (info.southWest.latitude.value() + info.northEast.latitude.value()),
               longitude = 0.5 * (info.southWest.longitude.value() + info.northEast.longitude.value());
  std::mt19937 random(19);
  std::uniform_real_distribution<double> unit(-1, 1);
  PlacementList list;
  for (int i = 0; i < 12; ++i) list.models.push_back(std::to_string(i));
  while (list.placements.size() < static_cast<std::size_t>(count)) {
    const double north = unit(random), east = unit(random);
    ListedPlacement p;
    p.latitude = Degrees{latitude + north * radiusKm / 111};
    p.longitude = Degrees{longitude + east * radiusKm / (111 * std::cos(latitude * std::numbers::pi / 180))};
    p.heading = Degrees{180 * unit(random)};
    p.scale = 1 + 0.3 * unit(random);
    p.model = static_cast<std::uint32_t>(random() % 40);
    // Most are trees; one in forty is a mast.
    p.model = p.model < 36 ? p.model % 8 : p.model - 28;
    const auto height = ground.heightAt(p.latitude, p.longitude);
    if (height && height->value() > 1) list.placements.push_back(p);
  }
  auto built =
      terrain::buildObjects(models(), list, ground, ground.patches()->index().frame, "scattered objects");
  if (!built) {
    std::cerr << toString(built.findings());
    return nullptr;
  }
  return std::make_shared<const terrain::ObjectTerrain>(std::move(built).value());
}

}  // namespace trimtab::bench
