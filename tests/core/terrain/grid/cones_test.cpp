#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/measure_levels.h"
#include "trimtab/terrain/patches/build.h"

/// Cones of normals against every triangle that can be drawn.
namespace trimtab::terrain {
namespace {

constexpr int kCells = TerrainIndex::kTileCells;

/// As a fraction of the grid's extent to the north, at fractions of the grid.
using Height = std::function<double(double east, double north)>;

double smooth(double east, double north) {
  return 0.06 * std::sin(9 * east) * std::cos(7 * north) + 0.2 * east;
}
double rough(double east, double north) {
  const double x = std::sin(east * 12989.8 + north * 78233.1) * 43758.5;
  return smooth(east, north) + 0.002 * (x - std::floor(x));
}
double flat(double, double) {
  return 0.01;
}

std::vector<float> heightsOf(const PostGrid& posts, const Height& height) {
  const double extent = posts.stepLatitude * posts.rows * 111320;
  std::vector<float> heights;
  for (std::uint32_t r = 0; r < posts.rows; ++r)
    for (std::uint32_t c = 0; c < posts.columns; ++c)
      heights.push_back(
          static_cast<float>(extent * height(double(c) / posts.columns, double(r) / posts.rows)));
  return heights;
}

struct Seen {
  std::size_t triangles = 0, known = 0;
  double widestExcess = -2;  ///< sine of a normal's angle less the cone's
  double slack = 0;          ///< mean of the cone's sine less the largest there is
};

void hold(const NormalCone& cone, const std::vector<Vec3>& normals, Seen& seen) {
  if (!cone.isKnown()) return;
  double largest = 0;
  for (const Vec3& n : normals) {
    ASSERT_GT(dot(n, cone.axis()), 0);
    largest = std::max(largest, length(cross(n, cone.axis())));
  }
  seen.triangles += normals.size();
  ++seen.known;
  seen.widestExcess = std::max(seen.widestExcess, largest - cone.sine());
  seen.slack += cone.sine() - largest;
}

void add(std::vector<Vec3>& normals, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  if (dot(n, n) > 0) normals.push_back(normalized(n));
}

/// A tile's triangles with no border folded, and with each that has a neighbour: one border's do not depend
/// on the others.
std::vector<Vec3> tileNormals(const TerrainIndex& index, const PostGrid& posts, const PostGeometry& geometry,
                              const std::vector<float>& heights, std::uint32_t node) {
  const TilePosts tile(index, posts, node);
  const auto beside = [&](std::size_t side) { return index.neighbours[node][side] != TerrainIndex::kNone; };
  std::vector<Vec3> normals;
  for (const bool folded : {false, true}) {
    const auto at = [&](int i, int j) {
      if (folded && j % 2 != 0 && ((i == 0 && beside(0)) || (i == kCells && beside(1)))) --j;
      if (folded && i % 2 != 0 && ((j == 0 && beside(2)) || (j == kCells && beside(3)))) --i;
      const std::uint32_t r = tile.row(static_cast<std::uint32_t>(j)),
                          c = tile.column(static_cast<std::uint32_t>(i));
      const auto p = geometry.lattice(r, c, double{heights[std::size_t{r} * posts.columns + c]});
      return Vec3{double(p.x), double(p.y), double(p.z)} * (1.0 / 256);
    };
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i) {
        const Vec3 sw = at(i, j), se = at(i + 1, j), nw = at(i, j + 1), ne = at(i + 1, j + 1);
        if ((i + j) % 2 == 0) {
          add(normals, sw, se, ne);
          add(normals, sw, ne, nw);
        } else {
          add(normals, sw, se, nw);
          add(normals, se, ne, nw);
        }
      }
  }
  return normals;
}

TEST(TileCones, holdEveryTriangleOfEveryTileAtAnyMixture) {
  for (const double latitude : {0.0, 36.0, -51.0, 69.0, 83.5, 88.0})
    for (const double step : {1.0 / 3600, 1.0 / 120})
      for (const Height& height : {Height(smooth), Height(rough), Height(flat)}) {
        const PostGrid posts{10, latitude, step, step, 200, 161};
        const std::vector<float> heights = heightsOf(posts, height);
        const PostGeometry geometry(posts);
        TerrainIndex index = makeLevels(posts);
        CellSlopes slopes(index);
        ASSERT_TRUE(measureLevels(posts, heights, geometry, index, slopes, {}));
        ASSERT_EQ(index.cones.size(), index.size());
        Seen seen;
        for (std::uint32_t node = 0; node < index.size(); ++node)
          hold(index.cones[node], tileNormals(index, posts, geometry, heights, node), seen);
        EXPECT_LE(seen.widestExcess, 0) << latitude << ' ' << step;
        // Near a pole and on wide tiles nothing is claimed.
        if (std::abs(latitude) < 60) {
          EXPECT_GT(seen.known, index.size() / 2) << latitude << ' ' << step;
        }
        // As tight as it needs to be to serve: a few degrees, but where a tile is wide on the earth.
        if (step < 0.001 && std::abs(latitude) < 60) {
          EXPECT_LT(seen.slack / static_cast<double>(seen.known), 0.05) << latitude << ' ' << step;
        }
      }
}

TEST(PatchCones, holdEveryTriangleOfEveryPatchInAnyVariant) {
  for (const auto& [latitude, leafCells] :
       {std::pair(0.0, kFineLeafCells), std::pair(45.0, kFineLeafCells), std::pair(-78.0, kFineLeafCells),
        std::pair(45.0, kCoarseLeafCells)}) {
    const PostGrid posts{10, latitude, 1.0 / 1200, 1.0 / 1200, 257, 193};
    HeightGrid grid;
    grid.posts = posts;
    grid.heights = heightsOf(posts, rough);
    const auto terrain = buildPatches(GridHeights(grid), 4, leafCells);
    const PatchIndex& index = terrain->index();
    ASSERT_EQ(index.cones.size(), index.size());
    Seen seen;
    for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
      const auto read = terrain->readPage(page);
      ASSERT_TRUE(read);
      for (std::size_t i = 0; i < read->patches.size(); ++i) {
        const PatchMesh& mesh = read->patches[i];
        std::vector<Vec3> normals;
        for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
          const auto at = [&](std::size_t k) {
            const PatchVertex& v = mesh.vertices[mesh.indices[t + k]];
            return Vec3{v.x, v.y, v.z};
          };
          add(normals, at(0), at(1), at(2));
        }
        hold(index.cones[index.pages[page].firstPatch + i], normals, seen);
      }
    }
    EXPECT_LE(seen.widestExcess, 0) << latitude;
    EXPECT_GT(seen.known, index.size() / 2);
    EXPECT_LT(seen.slack / static_cast<double>(seen.known), 0.05);
  }
}

}  // namespace
}  // namespace trimtab::terrain
