#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "trimtab/culling/select_objects.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/format/patch_terrain.h"

/// Objects for tests, made in memory.
namespace trimtab::test {

/// A terrain as it is, with other objects on it.
class ObjectsOn final : public terrain::Database {
 public:
  ObjectsOn(std::shared_ptr<const terrain::Database> ground,
            std::shared_ptr<const terrain::ObjectTerrain> objects)
      : ground_(std::move(ground)), objects_(std::move(objects)) {}

  const terrain::TerrainInfo& info() const override { return ground_->info(); }
  const TerrainIndex& index() const override { return ground_->index(); }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    ground_->buildTile(node, mesh);
  }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return ground_->heightAt(latitude, longitude);
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override {
    return ground_->highestWithin(latitude, longitude, radius);
  }
  std::shared_ptr<const terrain::StaticLodTerrain> staticLod() const override { return ground_->staticLod(); }
  std::shared_ptr<const terrain::PatchTerrain> patches() const override { return ground_->patches(); }
  std::shared_ptr<const terrain::GroundPyramid> ground() const override { return ground_->ground(); }
  std::shared_ptr<const terrain::ObjectTerrain> objects() const override { return objects_; }

 private:
  std::shared_ptr<const terrain::Database> ground_;
  std::shared_ptr<const terrain::ObjectTerrain> objects_;
};

/// Adds a model: a pyramid on a square of 2 * `halfM` for each of its levels, with as many sides as the level
/// says, and the error that a rounder one has.
inline void addCone(terrain::ObjectTerrain& to, float halfM, float heightM,
                    std::array<std::uint8_t, 4> colour, std::initializer_list<int> sides) {
  constexpr double kTurn = 6.283185307179586;
  ObjectIndex::Model model{static_cast<std::uint32_t>(to.index.levels.size()),
                           static_cast<std::uint32_t>(sides.size()), std::hypot(halfM, heightM)};
  for (const int n : sides) {
    to.meshes.push_back({static_cast<std::uint32_t>(to.vertices.size()),
                         static_cast<std::uint32_t>(to.indices.size()), static_cast<std::uint32_t>(3 * n),
                         0});
    to.vertices.push_back({.x = 0, .y = 0, .z = heightM, .colour = colour});
    for (int i = 0; i < n; ++i) {
      const auto x = static_cast<float>(std::cos(kTurn * i / n)),
                 y = static_cast<float>(std::sin(kTurn * i / n));
      to.vertices.push_back(
          {.x = halfM * x,
           .y = halfM * y,
           .z = 0,
           .normal = {static_cast<std::int8_t>(127 * x), static_cast<std::int8_t>(127 * y), 0},
           .colour = colour});
      for (const int v : {0, 1 + i, 1 + (i + 1) % n}) to.indices.push_back(static_cast<std::uint32_t>(v));
    }
    const double error = n == *sides.begin() ? 0 : halfM * (1 - std::cos(kTurn / 2 / n));
    to.index.levels.push_back(
        {static_cast<float>(error), static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(n + 1)});
  }
  to.index.models.push_back(model);
  to.names.push_back("cone " + std::to_string(to.names.size()));
}

/// An instance before it has a cell.
struct Planted {
  Vec3 foot;  ///< local frame
  std::array<std::int16_t, 4> turn;
  float scale;
  std::uint32_t model;
};

/// Fills instances and cells: a root over `side` x `side` cells of equal size, of which each that has an
/// instance is a leaf.
inline void intoCells(terrain::ObjectTerrain& to, std::vector<Planted> planted, int side) {
  ObjectIndex& index = to.index;
  double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
  for (const Planted& p : planted) {
    x0 = std::min(x0, p.foot.x), x1 = std::max(x1, p.foot.x);
    y0 = std::min(y0, p.foot.y), y1 = std::max(y1, p.foot.y);
  }
  const auto cellOf = [&](const Planted& p) {
    const auto along = [side](double at, double from, double to_) {
      return to_ > from ? std::min(static_cast<int>((at - from) / (to_ - from) * side), side - 1) : 0;
    };
    return along(p.foot.y, y0, y1) * side + along(p.foot.x, x0, x1);
  };
  std::stable_sort(planted.begin(), planted.end(),
                   [&](const Planted& a, const Planted& b) { return cellOf(a) < cellOf(b); });
  ObjectIndex::Cell root{.bounds = {1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f}};
  root.instances = static_cast<std::uint32_t>(planted.size());
  index.cells.assign(1, root);
  for (std::size_t i = 0; i < planted.size(); ++i) {
    const Planted& p = planted[i];
    if (i == 0 || cellOf(p) != cellOf(planted[i - 1])) {
      index.cells.push_back(root);
      ObjectIndex::Cell& cell = index.cells.back();
      cell.origin = {static_cast<std::int32_t>(std::lround(p.foot.x / 16)),
                     static_cast<std::int32_t>(std::lround(p.foot.y / 16)),
                     static_cast<std::int32_t>(std::lround(p.foot.z / 16))};
      cell.firstInstance = static_cast<std::uint32_t>(i);
      cell.instances = 0;
      cell.end = static_cast<std::uint32_t>(index.cells.size());
    }
    ObjectIndex::Cell& cell = index.cells.back();
    const auto in = [&](double at, std::size_t axis) {
      return static_cast<float>(at - 16.0 * cell.origin[axis]);
    };
    index.instances.push_back({in(p.foot.x, 0), in(p.foot.y, 1), in(p.foot.z, 2), p.turn, p.scale, p.model});
    ++cell.instances;
    const ObjectIndex::Model& model = index.models[p.model];
    const float radius = model.radiusM * p.scale, reach = radius * 1.001f + 0.1f;
    for (ObjectIndex::Cell* of : {&index.cells.front(), &cell}) {
      Box& b = of->bounds;
      const auto x = static_cast<float>(p.foot.x), y = static_cast<float>(p.foot.y),
                 z = static_cast<float>(p.foot.z);
      b = {std::min(b.minX, x - reach), std::min(b.minY, y - reach), std::min(b.minZ, z - reach),
           std::max(b.maxX, x + reach), std::max(b.maxY, y + reach), std::max(b.maxZ, z + reach)};
      of->largestRadiusM = std::max(of->largestRadiusM, radius);
      for (std::uint32_t level = 0; level + 1 < model.levels; ++level)
        of->coarsestFromM =
            std::max(of->coarsestFromM, index.levels[model.firstLevel + level + 1].errorM * p.scale);
    }
  }
  index.cells.front().end = static_cast<std::uint32_t>(index.cells.size());
}

/// Cones of three kinds at random places on a terrain, upright, of different sizes, `times`
/// as large as trees and masts.
inline std::shared_ptr<terrain::ObjectTerrain> scattered(const terrain::Database& ground, int count,
                                                         unsigned seed, int side = 24, double times = 1) {
  auto made = std::make_shared<terrain::ObjectTerrain>();
  made->index.frame = ground.patches() ? ground.patches()->index().frame : ground.index().frame;
  addCone(*made, 4, 15, {40, 90, 40, 255}, {16, 8, 4});
  addCone(*made, 2.5f, 9, {90, 80, 40, 255}, {12, 5});
  addCone(*made, 6, 30, {150, 150, 160, 255}, {24, 12, 6, 3});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const terrain::TerrainInfo& info = ground.info();
  std::vector<Planted> planted;
  while (planted.size() < static_cast<std::size_t>(count)) {
    const auto between = [&](Degrees a, Degrees b) {
      return Degrees{a.value() + (b.value() - a.value()) * (0.05 + 0.9 * unit(random))};
    };
    GeodeticPosition place{between(info.southWest.latitude, info.northEast.latitude),
                           between(info.southWest.longitude, info.northEast.longitude), Metres{0}};
    const auto height = ground.heightAt(place.latitude, place.longitude);
    if (!height) continue;
    place.height = *height;
    planted.push_back({made->index.frame.fromGeodetic(place),
                       {0, 0, 0, 32767},
                       static_cast<float>(times * (0.6 + 0.8 * unit(random))),
                       static_cast<std::uint32_t>(3 * unit(random))});
  }
  intoCells(*made, std::move(planted), side);
  return made;
}

/// Adds lights at places of the local frame, so many in a cell, in their order.
inline void addLights(terrain::ObjectTerrain& to, const std::vector<Vec3>& places, std::size_t inCell = 1) {
  for (std::size_t first = 0; first < places.size(); first += inCell) {
    LightIndex::Cell cell;
    const auto steps = [](double v) { return static_cast<std::int32_t>(std::lround(v / 16)); };
    cell.origin = {steps(places[first].x), steps(places[first].y), steps(places[first].z)};
    cell.first = static_cast<std::uint32_t>(to.lights.points.size());
    cell.bounds = {1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f};
    for (std::size_t i = first; i < std::min(first + inCell, places.size()); ++i, ++cell.count) {
      const Vec3& p = places[i];
      const auto in = [&](double at, std::size_t axis) {
        return static_cast<float>(at - 16.0 * cell.origin[axis]);
      };
      to.lights.points.push_back({in(p.x, 0), in(p.y, 1), in(p.z, 2), {255, 0, 255, 255}});
      const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
      Box& b = cell.bounds;
      b = {std::min(b.minX, x - 0.1f), std::min(b.minY, y - 0.1f), std::min(b.minZ, z - 0.1f),
           std::max(b.maxX, x + 0.1f), std::max(b.maxY, y + 0.1f), std::max(b.maxZ, z + 0.1f)};
    }
    to.lights.cells.push_back(cell);
  }
}

/// Adds a light so far above each instance.
inline void lightEach(terrain::ObjectTerrain& to, Metres above) {
  std::vector<Vec3> places;
  for (std::uint32_t i = 0; i < to.index.instances.size(); ++i)
    places.push_back(placeOfObject(to.index, i) + Vec3{0, 0, above.value()});
  addLights(to, places);
}

}  // namespace trimtab::test
