#include "trimtab/culling/depth_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "depth_ground.h"
#include "trimtab/culling/frustum.h"

namespace trimtab {
namespace {

using test::axesOf;
using test::randomView;
using Ground = test::DepthGround;
using Truth = test::PixelOwners;
using View = test::DepthView;

constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

struct Tally {
  std::size_t nearer = 0, covered = 0, coverable = 0, hidden = 0, wrong = 0, trulyHidden = 0;
};
Box boxOf(const DepthMesh& m) {
  const auto f = [&](std::size_t side, double origin) {
    return static_cast<float>(double{m.boxes[side][0]} + origin);
  };
  return {f(0, m.origin.x), f(1, m.origin.y), f(2, m.origin.z),
          f(3, m.origin.x), f(4, m.origin.y), f(5, m.origin.z)};
}
Tally fly(int views, double lowering) {
  Tally tally;
  std::mt19937 random(5);
  const depth::Triangles indices = Ground::indices();
  DepthMap map;
  for (int i = 0; i < views; ++i) {
    const Ground ground(static_cast<unsigned>(i));
    const View v = randomView(ground, random, i);
    const Truth truth(ground, v.eye, v.shape);
    map.begin(v.eye, v.shape, {v.width, v.height, lowering});
    std::vector<DepthMesh> meshes;
    for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile) meshes.push_back(ground.mesh(tile));
    std::vector<DepthFate> fates(meshes.size(), DepthFate::seen);
    for (std::size_t t = 0; t < meshes.size(); ++t)
      if (Ground::mayOcclude(static_cast<int>(t))) fates[t] = map.draw(meshes[t], indices);
    map.finish();
    for (std::size_t t = 0; t < meshes.size(); ++t)
      if (fates[t] == DepthFate::seen) fates[t] = map.test(meshes[t]);
    const Frustum frustum(v.eye, v.shape);
    std::vector<bool> owns(meshes.size());
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x) {
        const auto pixel = static_cast<std::size_t>(y * truth.width + x);
        const int tx = static_cast<int>((x + 0.5) * v.width / truth.width),
                  ty = static_cast<int>((y + 0.5) * v.height / truth.height);
        const double shown = double{map.pyramid().depths()[static_cast<std::size_t>(ty * v.width + tx)]};
        const bool there = std::isfinite(truth.depth[pixel]);
        if (there) owns[static_cast<std::size_t>(truth.owner[pixel])] = true;
        tally.coverable += there;
        tally.covered += shown > 0;
        tally.nearer += shown > 0 && !(truth.depth[pixel] <= v.shape.nearM / shown * 1.0001);
      }
    for (std::size_t t = 0; t < meshes.size(); ++t) {
      const bool left = fates[t] != DepthFate::seen;
      tally.wrong += left && owns[t];
      if (!frustum.mayShow(boxOf(meshes[t]))) continue;
      tally.hidden += left;
      tally.trulyHidden += !owns[t];
    }
  }
  return tally;
}

TEST(DepthMap, isNowhereNearerThanAnyPixelOfItsTexels) {
  const Tally tally = fly(24, 1);
  EXPECT_EQ(tally.nearer, 0u) << "of " << tally.covered;
  EXPECT_EQ(tally.wrong, 0u) << "of " << tally.hidden;
  EXPECT_GT(tally.covered * 10, tally.coverable * 5) << "it covers hardly anything";
  EXPECT_GT(tally.hidden * 10, tally.trulyHidden * 3) << "it hides hardly anything";
}

// Without this, the test above might pass because nothing can go wrong where it looks.
TEST(DepthMap, isNearerWhereNothingIsLowered) {
  EXPECT_GT(fly(6, 0).nearer, 20u);
}

TEST(DepthMap, isTheSameWhateverTheProcessorHas) {
  std::mt19937 random(9);
  const depth::Triangles indices = Ground::indices();
  for (int i = 0; i < 24; ++i) {
    const Ground ground(static_cast<unsigned>(i));
    const View v = randomView(ground, random, i);
    std::vector<float> first;
    std::vector<DepthFate> fates;
    for (const SimdLevel level : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
      DepthMap map;
      map.begin(v.eye, v.shape, {v.width, v.height, 1, level});
      std::vector<DepthFate> now;
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        now.push_back(map.draw(ground.mesh(tile), indices));
      map.finish();
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        now.push_back(map.test(ground.mesh(tile)));
      const std::vector<float> depths(map.pyramid().depths().begin(), map.pyramid().depths().end());
      if (level == SimdLevel::portable) first = depths, fates = now;
      ASSERT_EQ(depths, first) << i;
      ASSERT_EQ(now, fates) << i;
    }
  }
}

TEST(DepthMap, hidesNothingForViewsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Ground ground(1);
  const depth::Triangles indices = Ground::indices();
  const EyePose good = {{640, 640, 400}, axesOf(17, -17)};
  struct Case {
    const char* what;
    std::function<void(EyePose&, ViewShape&, DepthMap::Settings&)> change;
  };
  const std::vector<Case> cases{
      {"an eye that is no place", [&](auto& e, auto&, auto&) { e.position.x = nan; }},
      {"an infinite eye",
       [&](auto& e, auto&, auto&) { e.position.z = std::numeric_limits<double>::infinity(); }},
      {"no direction",
       [&](auto& e, auto&, auto&) {
         e.axes.row[0] = e.axes.row[1] = e.axes.row[2] = {nan, nan, nan};
       }},
      {"half a direction",
       [&](auto& e, auto&, auto&) {
         e.axes.row[0] = {nan, nan, nan};
       }},
      {"no field of view", [&](auto&, auto& v, auto&) { v.left = v.right = 0; }},
      {"none either way", [&](auto&, auto& v, auto&) { v.left = v.right = v.bottom = v.top = 0; }},
      {"sides that are no numbers",
       [&](auto&, auto& v, auto&) { v.left = v.right = v.bottom = v.top = nan; }},
      {"no near plane", [&](auto&, auto& v, auto&) { v.nearM = nan; }},
      {"no map", [&](auto&, auto&, auto& s) { s.width = 0; }},
      {"less than none", [&](auto&, auto&, auto& s) { s.width = -5, s.height = -7; }},
  };
  for (const Case& c : cases) {
    EyePose eye = good;
    ViewShape view;
    DepthMap::Settings settings{100, 60};
    c.change(eye, view, settings);
    DepthMap map;
    map.begin(eye, view, settings);
    for (int pass = 0; pass < 2; ++pass)
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        EXPECT_NE(map.draw(ground.mesh(tile), indices), DepthFate::hidden) << c.what;
    map.finish();
    for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
      EXPECT_NE(map.test(ground.mesh(tile)), DepthFate::hidden) << c.what;
  }
}

TEST(DepthMap, neverHidesAMeshThatIsNotOfNumbers) {
  const Ground ground(2);
  const depth::Triangles indices = Ground::indices();
  // A wall before everything.
  DepthMesh wall;
  wall.setVertices(4);
  wall.setVertex(0, -1e4f, 20, -1e4f, 0);
  wall.setVertex(1, 1e4f, 20, -1e4f, 0);
  wall.setVertex(2, 1e4f, 20, 1e4f, 0);
  wall.setVertex(3, -1e4f, 20, 1e4f, 0);
  wall.finishVertices();
  wall.reach = wall.farReach = 1e9f;
  wall.setBoxes(std::vector<Box>{{-1e4f, 20, -1e4f, 1e4f, 20, 1e4f}});
  DepthMap map;
  map.begin({{640, -200, 100}, axesOf(0)}, {}, {200, 100, 0});
  wall.origin = {640, -200, 100};
  map.draw(wall, depth::Triangles(std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3}));
  map.finish();
  DepthMesh mesh = ground.mesh(14);
  ASSERT_EQ(map.test(mesh), DepthFate::hidden);
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNanF, inf, -inf}) {
    std::vector<Box> parts{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, bad}};
    mesh.setBoxes(parts);
    EXPECT_EQ(map.test(mesh), DepthFate::seen) << bad;
    EXPECT_EQ(map.draw(mesh, indices), DepthFate::seen) << bad;
  }
  mesh.setBoxes({});
  EXPECT_EQ(map.test(mesh), DepthFate::seen) << "nothing is known of it";
  mesh = ground.mesh(14);
  mesh.origin.y = -400;
  EXPECT_NE(map.test(mesh), DepthFate::hidden) << "the eye is in its box";
}

}  // namespace
}  // namespace trimtab
