#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ridge_ground.h"

namespace trimtab {
namespace {

using Ground = test::RidgeGround;

TEST(MeshRelief, hasLinesThatLieOnTheSurfaceFromBorderToBorder) {
  const Ground ground(3, 16, 60, 4);
  for (const MeshRelief& mesh : ground.meshes(5)) {
    ASSERT_GE(mesh.lines(), 6u);
    EXPECT_TRUE(mesh.upright);
    for (std::size_t line = 0; line < mesh.lines(); ++line) {
      const std::size_t first = mesh.lineFirst[line], end = mesh.lineFirst[line + 1];
      EXPECT_NEAR(
          std::hypot(mesh.lineX[end - 1] - mesh.lineX[first], mesh.lineY[end - 1] - mesh.lineY[first]),
          16 * 60, 1e-2);
      // Between two corners it is straight, and so is the surface.
      for (std::size_t i = first; i + 1 < end; ++i)
        for (const double s : {0.0, 0.3, 0.5, 0.8}) {
          const auto at = [&](const std::vector<float>& v) { return v[i] + s * (double{v[i + 1]} - v[i]); };
          const Vec3 p = mesh.origin + Vec3{at(mesh.lineX), at(mesh.lineY), at(mesh.lineZ)};
          EXPECT_NEAR(ground.heightAt(p.x, p.y), p.z, 1e-3);
        }
    }
  }
}

TEST(MeshRelief, keepsEveryTriangleOnce) {
  const Ground ground(2, 16, 60, 4);
  for (const MeshRelief& mesh : ground.meshes(4)) {
    std::size_t triangles = 0;
    double area = 0;
    for (const MeshRelief::Part& part : mesh.parts) {
      triangles += part.triangles;
      for (std::size_t i = 0; i < part.triangles; ++i) {
        const std::uint8_t* c = &mesh.corners[part.firstCorner + 3 * i];
        const auto x = [&](int k) { return double{mesh.x[part.firstVertex + c[k]]}; };
        const auto y = [&](int k) { return double{mesh.y[part.firstVertex + c[k]]}; };
        area += 0.5 * ((x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0)));
      }
    }
    EXPECT_EQ(triangles, 2u * 16 * 16);
    EXPECT_NEAR(area, 960.0 * 960, 1);
  }
}

TEST(MeshRelief, isNoSurfaceWhereItStandsUprightOrIsNoNumber) {
  const std::vector<std::uint16_t> one{0, 1, 2};
  MeshRelief relief;
  makeMeshRelief(std::vector<ReliefVertex>{{0, 0, 0, 0, 0}, {10, 0, 5, 1, 0}, {0, 10, 0, 0, 1}}, one, {}, 1,
                 relief);
  EXPECT_TRUE(relief.upright);
  EXPECT_NEAR(relief.steepest, 0.5, 1e-6);
  makeMeshRelief(std::vector<ReliefVertex>{{0, 0, 0, 0, 0}, {0, 0, 10, 1, 0}, {0, 10, 0, 0, 1}}, one, {}, 1,
                 relief);
  EXPECT_FALSE(relief.upright);
  EXPECT_EQ(relief.lines(), 0u);
  makeMeshRelief(std::vector<ReliefVertex>{{0, 0, 0, 0, 0}, {0, 10, 0, 1, 0}, {10, 0, 0, 0, 1}}, one, {}, 1,
                 relief);
  EXPECT_FALSE(relief.upright) << "it faces down";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  makeMeshRelief(std::vector<ReliefVertex>{{0, 0, nan, 0, 0}, {10, 0, 0, 1, 0}, {0, 10, 0, 0, 1}}, one, {}, 1,
                 relief);
  EXPECT_FALSE(relief.upright);
  EXPECT_TRUE(relief.parts.empty());
  makeMeshRelief({}, {}, {}, 1, relief);
  EXPECT_TRUE(relief.parts.empty());
}

TEST(MeshRelief, leavesOutLinesThatAreTooLongToBeTaken) {
  for (const int cells : {190, 200}) {
    std::vector<ReliefVertex> vertices;
    std::vector<std::uint16_t> indices;
    for (int y = 0; y <= 4; ++y)
      for (int x = 0; x <= cells; ++x)
        vertices.push_back({static_cast<float>(10 * x), static_cast<float>(10 * y), 0,
                            static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < cells; ++x) {
        const auto sw = static_cast<std::uint16_t>(y * (cells + 1) + x),
                   se = static_cast<std::uint16_t>(sw + 1), nw = static_cast<std::uint16_t>(sw + cells + 1),
                   ne = static_cast<std::uint16_t>(nw + 1);
        indices.insert(indices.end(), {sw, se, ne, sw, ne, nw});
      }
    MeshRelief relief;
    makeMeshRelief(vertices, indices, {}, 2, relief);
    std::size_t rows = 0;
    for (std::size_t line = 0; line < relief.lines(); ++line) {
      EXPECT_LE(relief.lineFirst[line + 1] - relief.lineFirst[line], std::uint32_t{MeshRelief::kMostCorners});
      rows += relief.lineY[relief.lineFirst[line]] == relief.lineY[relief.lineFirst[line + 1] - 1];
    }
    EXPECT_GT(relief.lines(), 90u) << "columns";
    EXPECT_EQ(rows > 0, cells == 190);
  }
}

}  // namespace
}  // namespace trimtab
