#include "core/scene/terrain/box_lids.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/core/culling/ridge_ground.h"

namespace trimtab {
namespace {

using scene::BoxLids;

constexpr float kInfinityF = std::numeric_limits<float>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

/// Of the lid over a place of the plan; -infinity where it is not over it. In doubles, by its triangles.
double heightOver(const MeshRelief& lid, double x, double y) {
  for (const MeshRelief::Part& part : lid.parts)
    for (std::size_t t = 0; t < part.triangles; ++t) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = part.firstVertex + lid.corners[part.firstCorner + 3 * t + k];
        p[k] = lid.origin + Vec3{lid.x[v], lid.y[v], lid.z[v]};
      }
      const auto twice = [](const Vec3& a, const Vec3& b, double px, double py) {
        return (b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x);
      };
      const double a = twice(p[1], p[2], x, y), b = twice(p[2], p[0], x, y), c = twice(p[0], p[1], x, y);
      if (a >= 0 && b >= 0 && c >= 0) return (a * p[0].z + b * p[1].z + c * p[2].z) / (a + b + c);
    }
  return -std::numeric_limits<double>::infinity();
}

Vec3 placeIn(const Box& b, double x, double y, double z) {
  return {b.minX + x * (double{b.maxX} - b.minX), b.minY + y * (double{b.maxY} - b.minY),
          b.minZ + z * (double{b.maxZ} - b.minZ)};
}

TEST(BoxLids, areOverAllOfTheirBoxes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  BoxLids lids;
  lids.reset(400);
  for (std::uint32_t node = 0; node < 400; ++node) {
    // From a metre to 1,000 km, as far from the frame's origin; some without extent.
    const float size = std::pow(10.0f, 6 * unit(random)), away = 1e6f * (2 * unit(random) - 1);
    Box box{away, -away, 9000 * unit(random) - 500, 0, 0, 0};
    box.maxX = box.minX + size * unit(random);
    box.maxY = box.minY + (node % 5 == 0 ? 0 : size * unit(random));
    box.maxZ = box.minZ + (node % 7 == 0 ? 0 : 3000 * unit(random));
    const MeshRelief* lid = lids.of(node, box);
    ASSERT_TRUE(lid->upright) << node;
    for (int k = 0; k < 60; ++k) {
      const Vec3 p = k < 4 ? placeIn(box, k % 2, k / 2, 1) : placeIn(box, unit(random), unit(random), 1);
      ASSERT_GE(heightOver(*lid, p.x, p.y), double{box.maxZ}) << node << ", place " << k;
    }
    EXPECT_EQ(heightOver(*lid, box.minX - 1.0, box.minY), -std::numeric_limits<double>::infinity());
  }
}

/// Boxes on rough ground, most of them higher than it: whatever the horizon says is hidden for its lid, no
/// way from the eye to any place of the box is clear of the ground.
TEST(BoxLids, areHiddenOnlyWhereAllOfTheirBoxesIs) {
  const test::RidgeGround ground(10, 16, 60, 4);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t hidden = 0, wrong = 0;
  for (int i = 0; i < 30; ++i) {
    const auto placeOf = [&] { return ground.sideM() * (0.1 + 0.8 * unit(random)); };
    Vec3 eye{placeOf(), placeOf(), 0};
    eye.z = ground.heightAt(eye.x, eye.y) + 5 + 100 * unit(random);
    BoxLids lids;
    lids.reset(100);
    std::vector<HorizonTile> tiles = ground.tiles();
    std::vector<Box> boxes;
    for (std::uint32_t node = 0; node < 100; ++node) {
      Box box{};
      box.minX = static_cast<float>(placeOf());
      box.minY = static_cast<float>(placeOf());
      box.maxX = box.minX + static_cast<float>(400 * unit(random));
      box.maxY = box.minY + static_cast<float>(400 * unit(random));
      box.minZ = static_cast<float>(ground.heightAt(box.minX, box.minY));
      box.maxZ = box.minZ + static_cast<float>(80 * unit(random));
      boxes.push_back(box);
      tiles.push_back({.mesh = lids.of(node, box)});
    }
    Horizon horizon;
    horizon.build(eye, tiles, {});
    for (std::size_t node = 0; node < boxes.size(); ++node) {
      if (horizon.hidden()[tiles.size() - boxes.size() + node] == 0) continue;
      ++hidden;
      for (int k = 0; k < 40; ++k) {
        // Its upper corners, edges and places of its top are seen first.
        const double x = k % 3 == 0 ? std::round(unit(random)) : unit(random),
                     y = k % 2 == 0 ? std::round(unit(random)) : unit(random);
        wrong += !ground.isCovered(eye, placeIn(boxes[node], x, y, k < 30 ? 1 : unit(random)));
      }
    }
  }
  EXPECT_GT(hidden, 300u);
  EXPECT_EQ(wrong, 0u);
}

TEST(BoxLids, hideNothing) {
  BoxLids lids;
  lids.reset(2);
  // A roof as high as the eye, and what is low and far behind it.
  std::vector<HorizonTile> tiles{{.mayOcclude = true, .mesh = lids.of(0, {500, -4000, 0, 3000, 4000, 990})},
                                 {.mesh = lids.of(1, {9000, -100, 0, 9200, 100, 10})}};
  EXPECT_EQ(tiles[0].mesh->lines(), 0u);
  for (const bool noWaiting : {false, true}) {
    Horizon horizon;
    horizon.build({0, 0, 1000}, tiles, {.whole = true, .noWaiting = noWaiting});
    EXPECT_EQ(horizon.hiddenCount(), 0u);
    EXPECT_FALSE(horizon.blocks({1, 0, -0.1}));
  }
}

/// A node whose bounds are no place is never hidden; walls all round hide the same one where they are.
TEST(BoxLids, ofBoundsThatAreNoPlacesAreNeverHidden) {
  std::array<TileRelief, 4> walls;
  std::vector<HorizonTile> tiles;
  for (int side = 0; side < 4; ++side) {
    TileRelief& wall = walls[static_cast<std::size_t>(side)];
    wall.side = 17;
    for (int row = 0; row < 17; ++row)
      for (int column = 0; column < 17; ++column) {
        const double f = 1000 + 5 * row, l = -1500 + 3000.0 * column / 16;
        constexpr std::array<std::array<double, 2>, 4> kForward{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
        const auto [a, b] = kForward[static_cast<std::size_t>(side)];
        wall.x.push_back(static_cast<float>(a * f - b * l));
        wall.y.push_back(static_cast<float>(b * f + a * l));
        wall.z.push_back(5000);
      }
    wall.finish(4);
    tiles.push_back({.relief = &wall, .mayOcclude = true});
  }
  const Box good{3000, 3000, 0, 4000, 4000, 100};
  BoxLids lids;
  lids.reset(64);
  std::uint32_t node = 0;
  tiles.push_back({.mesh = lids.of(node++, good)});
  const auto with = [&](float Box::*side, float value) {
    Box box = good;
    box.*side = value;
    tiles.push_back({.mesh = lids.of(node++, box)});
  };
  for (const float value : {kNanF, kInfinityF, -kInfinityF})
    for (float Box::*side : {&Box::minX, &Box::minY, &Box::maxX, &Box::maxY, &Box::maxZ}) with(side, value);
  tiles.push_back(
      {.mesh = lids.of(node++, {-kInfinityF, -kInfinityF, -kInfinityF, kInfinityF, kInfinityF, kInfinityF})});
  tiles.push_back({.mesh = lids.of(node++, {-kInfinityF, -kInfinityF, 0, kInfinityF, kInfinityF, 100})});
  // What the eye stands in.
  tiles.push_back({.mesh = lids.of(node++, {-100, -100, 0, 100, 100, 100})});
  Horizon horizon;
  horizon.build({0, 0, 50}, tiles, {});
  EXPECT_EQ(horizon.hidden()[4], 1) << "the walls hide";
  for (std::size_t t = 5; t < tiles.size(); ++t) EXPECT_EQ(horizon.hidden()[t], 0) << t;
}

TEST(BoxLids, stayWhileTheirNodesAreThoseOfTheCut) {
  BoxLids lids;
  lids.reset(3);
  const Box box{0, 0, 0, 10, 10, 10};
  const MeshRelief* lid = lids.of(1, box);
  EXPECT_EQ(lids.of(1, box), lid);
  EXPECT_NE(lids.of(2, box), lid);
  EXPECT_EQ(lids.of(2, box)->bounds.maxZ, lid->bounds.maxZ) << "the same box";
  EXPECT_EQ(lids.of(2, box)->bounds.maxX, lid->bounds.maxX);
  LevelCut cut;
  cut.tiles = {TileDraw{1}};
  lids.forgetOthers(cut);
  EXPECT_EQ(lids.of(1, box), lid);
}

}  // namespace
}  // namespace trimtab
