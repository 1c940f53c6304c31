#include "trimtab/culling/depth_raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "depth_ground.h"
#include "trimtab/culling/depth_map.h"

namespace trimtab {
namespace {

using test::axesOf;

/// Triangles by themselves, looked at along +y from the origin with a texel at a depth of 1 being 1/50.
class DepthRaster : public testing::Test {
 protected:
  static constexpr int kWidth = 100, kHeight = 60;
  DepthRaster() {
    view.left = -1, view.right = 1, view.bottom = -0.6, view.top = 0.6;
    view.widthPx = kWidth, view.heightPx = kHeight;
  }
  using Corners = std::array<Vec3, 3>;  ///< texel x and y, depth in metres
  static Vec3 place(Vec3 c) {
    return {(c.x - kWidth / 2.0) / 50 * c.z, c.z, (c.y - kHeight / 2.0) / 50 * c.z};
  }
  void draw(const std::vector<Corners>& triangles) {
    DepthMesh mesh;
    mesh.setVertices(3 * triangles.size());
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
      const Vec3 p = place(triangles[i / 3][i % 3]);
      mesh.setVertex(i, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0);
      indices.push_back(static_cast<std::uint16_t>(i));
    }
    mesh.finishVertices();
    mesh.reach = mesh.farReach = 1e9f;
    mesh.setBoxes(std::vector<Box>{{-1e6f, 0, -1e6f, 1e6f, 1e6f, 1e6f}});
    map.begin({{}, axesOf(0)}, view, {kWidth, kHeight, 0});
    map.draw(mesh, depth::Triangles(indices));
    map.finish();
  }
  double at(int x, int y) const {
    return double{map.pyramid().depths()[static_cast<std::size_t>(y * kWidth + x)]};
  }
  std::size_t covered() const {
    return static_cast<std::size_t>(std::count_if(
        map.pyramid().depths().begin(), map.pyramid().depths().end(), [](float d) { return d > 0; }));
  }

  /// near / depth of the triangle's nearest point to a place, if that is within `reach` texels; else 0.
  static double twin(const Corners& t, double x, double y, double reach) {
    const auto w = [&](std::size_t k) { return 1 / t[k].z; };
    const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
    if (!(area > 0)) return 0;
    double best = 1e9, depth = 0;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = t[k], &b = t[(k + 1) % 3];
      const double dx = b.x - a.x, dy = b.y - a.y, size = dx * dx + dy * dy;
      inside = inside && dx * (y - a.y) - dy * (x - a.x) >= 0;
      const double along = size > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / size, 0.0, 1.0) : 0;
      const double off = std::hypot(a.x + along * dx - x, a.y + along * dy - y);
      if (off < best) best = off, depth = w(k) + along * (w((k + 1) % 3) - w(k));
    }
    if (!inside) return best <= reach ? depth : 0;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
      sum += ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area * w(k);
    }
    return sum;
  }

  ViewShape view;
  DepthMap map;
};

TEST_F(DepthRaster, isNowhereNearerThanATwinInDoublePrecision) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t shown = 0, missed = 0, shouldBe = 0;
  for (int round = 0; round < 150; ++round) {
    std::vector<Corners> triangles;
    for (int i = 0; i < 12; ++i) {
      Corners t;
      const double size = std::pow(10, -1 + 3.5 * unit(random));
      const Vec3 middle{140 * unit(random) - 20, 90 * unit(random) - 15, 0};
      for (Vec3& c : t)
        c = middle + Vec3{size * (unit(random) - 0.5), size * (unit(random) - 0.5),
                          std::pow(10, 0.5 + 3.5 * unit(random))};
      // Slivers, and edge-on ones.
      if (i % 4 == 1)
        t[2] = t[0] + (t[1] - t[0]) * unit(random) + Vec3{1e-3 * unit(random), 1e-3 * unit(random), 0};
      if (i % 4 == 2) t[1].z = t[0].z * (1 + 1e-3 * unit(random)), t[2].z = t[0].z;
      triangles.push_back(t);
    }
    draw(triangles);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        double nearest = 0, certain = 0;
        for (const Corners& t : triangles) {
          nearest = std::max(nearest, twin(t, x + 0.5, y + 0.5, 0.02));
          certain = std::max(certain, twin(t, x + 0.5, y + 0.5, 0));
        }
        ASSERT_LE(at(x, y), nearest * (1 + 1e-5)) << round << ": " << x << ", " << y;
        shown += at(x, y) > 0;
        shouldBe += certain > 0;
        missed += certain > 0 && !(at(x, y) > 0);
      }
  }
  EXPECT_GT(shown, 100000u);
  EXPECT_LT(missed * 1000, shouldBe) << "there are holes";
}

TEST_F(DepthRaster, cutsWhatReachesBehindTheEye) {
  // A floor 2 m under the eye, from behind it to 200 m ahead.
  DepthMesh floor;
  floor.setVertices(4);
  floor.setVertex(0, -500, -300, -2, 0);
  floor.setVertex(1, 500, -300, -2, 0);
  floor.setVertex(2, 500, 200, -2, 0);
  floor.setVertex(3, -500, 200, -2, 0);
  floor.finishVertices();
  floor.reach = floor.farReach = 1e9f;
  floor.setBoxes(std::vector<Box>{{-500, -300, -2, 500, 200, -2}});
  map.begin({{}, axesOf(0)}, view, {kWidth, kHeight, 0});
  EXPECT_EQ(map.draw(floor, depth::Triangles(std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3})),
            DepthFate::seen);
  map.finish();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double down = (kHeight / 2.0 - y - 0.5) / 50, depth = 2 / down;
      if (down <= 0 || depth > 198) {
        EXPECT_LE(at(x, y), 1 / 198.0) << x << ", " << y;
      } else {
        EXPECT_LE(at(x, y), 1.00001 / depth) << x << ", " << y;
        EXPECT_GT(at(x, y), 0.9 / depth - 0.001) << x << ", " << y;
      }
    }
}

TEST_F(DepthRaster, coversNothingWithWhatIsNoTriangle) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Corners good{Vec3{10, 10, 100}, Vec3{90, 10, 100}, Vec3{50, 50, 100}};
  draw({good});
  EXPECT_GT(covered(), 1000u);
  for (const Vec3& bad : {Vec3{nan, 10, 100}, Vec3{50, nan, 100}, Vec3{50, 50, nan}, Vec3{inf, 10, 100},
                          Vec3{50, 50, inf}, Vec3{50, 50, -inf}, Vec3{1e30, 1e30, 1e9}}) {
    for (std::size_t k = 0; k < 3; ++k) {
      Corners t = good;
      t[k] = bad;
      draw({t});
      EXPECT_EQ(covered(), 0u) << bad.x << ", " << bad.y << ", " << bad.z << " at " << k;
    }
  }
  draw({{good[0], good[0], good[1]},
        {good[0], good[1], good[1]},
        {good[0], good[1], (good[0] + good[1]) * 0.5}});
  EXPECT_EQ(covered(), 0u) << "a triangle without a surface";
  draw({{good[0], good[2], good[1]}});
  EXPECT_EQ(covered(), 0u) << "from behind";
  draw({{Vec3{10, 10, -100}, Vec3{90, 10, -100}, Vec3{50, 50, -100}}});
  EXPECT_EQ(covered(), 0u) << "behind the eye";
}

}  // namespace
}  // namespace trimtab
