#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "core/scene/occlusion/occluder.h"
#include "core/scene/surface/tile_indices.h"
#include "synthetic_terrain.h"

namespace trimtab {
namespace {

constexpr int kSide = terrain::TileMesh::kSide;

std::span<const std::uint16_t> variant(const scene::TileIndices& indices, unsigned coarser) {
  const auto range = indices.variant[coarser];
  return std::span(indices.indices).subspan(range.first, range.count);
}

TEST(TileIndices, coverTheTileOnceInEveryVariant) {
  const auto indices = scene::makeTileIndices();
  for (unsigned coarser = 0; coarser < 16; ++coarser) {
    const auto triangles = variant(indices, coarser);
    EXPECT_EQ(triangles.size() / 3, 2048u - 16 * static_cast<unsigned>(std::popcount(coarser)));
    int doubleArea = 0;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
      const auto x = [&](std::size_t k) { return triangles[i + k] % kSide; };
      const auto y = [&](std::size_t k) { return triangles[i + k] / kSide; };
      const int area = (x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0));
      ASSERT_GT(area, 0) << "folded over or turned, variant " << coarser;
      doubleArea += area;
    }
    EXPECT_EQ(doubleArea, 2 * 32 * 32);
  }
}

TEST(TileIndices, useEvenPostsAloneOnACoarserSide) {
  const auto indices = scene::makeTileIndices();
  for (unsigned coarser = 0; coarser < 16; ++coarser)
    for (const std::uint16_t i : variant(indices, coarser)) {
      const int x = i % kSide, y = i / kSide;
      if (y % 2 != 0) {
        ASSERT_FALSE(x == 0 && (coarser & 1u));
        ASSERT_FALSE(x == 32 && (coarser & 2u));
      }
      if (x % 2 != 0) {
        ASSERT_FALSE(y == 0 && (coarser & 4u));
        ASSERT_FALSE(y == 32 && (coarser & 8u));
      }
    }
}

struct Surface {
  std::vector<Vec3> points;
  std::vector<std::uint16_t> triangles;
  std::optional<double> over(double px, double py) const {
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
      const Vec3 a = points[triangles[i]], b = points[triangles[i + 1]], c = points[triangles[i + 2]];
      const auto area = [](double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; };
      const double whole = area(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
      const double v = area(px - a.x, py - a.y, c.x - a.x, c.y - a.y) / whole,
                   w = area(b.x - a.x, b.y - a.y, px - a.x, py - a.y) / whole;
      if (v >= 0 && w >= 0 && v + w <= 1) return a.z + v * (b.z - a.z) + w * (c.z - a.z);
    }
    return {};
  }
};

TEST(Occluder, isNeverAboveTheTileAsDrawnHoweverItsSidesAreStitched) {
  const test::SyntheticTerrain terrain(8, 1.0 / 1200, {Degrees{45}, Degrees{7}, Metres{0}}, test::mountains);
  const auto indices = scene::makeTileIndices();
  const auto coarse = scene::makeCoarseIndices(scene::kOccluderStep);
  terrain::TileMesh mesh;
  scene::TileOccluder occluder;
  std::mt19937 random(3);
  for (std::uint32_t node = 0; node < terrain.index().size(); node += 7) {
    terrain.buildTile(node, mesh);
    scene::makeOccluder(mesh, terrain.index().slopeMax[node], occluder);
    Surface low, drawn;
    for (const auto& v : occluder.vertices) low.points.push_back({v.x, v.y, v.z});
    low.triangles = coarse;
    for (const auto& v : mesh.vertices) drawn.points.push_back({v.x, v.y, v.z});
    const unsigned coarser = node * 5 % 16;
    const auto range = variant(indices, coarser);
    drawn.triangles.assign(range.begin(), range.end());
    const auto& box = terrain.index().bounds[node];
    std::uniform_real_distribution<double> x(box.minX - 16.0 * mesh.origin[0],
                                             box.maxX - 16.0 * mesh.origin[0]);
    std::uniform_real_distribution<double> y(box.minY - 16.0 * mesh.origin[1],
                                             box.maxY - 16.0 * mesh.origin[1]);
    int compared = 0;
    for (int i = 0; i < 400; ++i) {
      const double px = x(random), py = y(random);
      const auto below = low.over(px, py), above = drawn.over(px, py);
      if (!below || !above) continue;
      ASSERT_LE(*below, *above) << "node " << node << ", variant " << coarser;
      ++compared;
    }
    EXPECT_GT(compared, 300);
    for (const auto& part : occluder.parts) {
      EXPECT_GE(part.low[0], box.minX - 16.0f * static_cast<float>(mesh.origin[0]) - 0.1f);
      EXPECT_LE(part.high[2], box.maxZ - 16.0f * static_cast<float>(mesh.origin[2]) + 0.1f);
    }
  }
}

}  // namespace
}  // namespace trimtab
