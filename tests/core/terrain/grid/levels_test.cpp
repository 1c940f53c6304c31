#include <GeographicLib/LocalCartesian.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/grid/post_grid.h"

/// What the index says of the levels, against the vertices that are drawn and the posts they stand for.
namespace trimtab::terrain {
namespace {

constexpr std::uint32_t kTileCells = TerrainIndex::kTileCells;
constexpr int kSide = TileMesh::kSide;

std::array<std::int64_t, 3> absolute(const TileMesh& mesh, std::size_t vertex) {
  const TileVertex& v = mesh.vertices[vertex];
  const auto whole = [](std::int32_t origin, float part) {
    const double steps = static_cast<double>(part) * 256;
    EXPECT_EQ(steps, std::floor(steps));
    return std::int64_t{origin} * 16 * 256 + static_cast<std::int64_t>(steps);
  };
  return {whole(mesh.origin[0], v.x), whole(mesh.origin[1], v.y), whole(mesh.origin[2], v.z)};
}
Vec3 place(const TileMesh& mesh, int i, int j) {
  const TileVertex& v = mesh.vertices[static_cast<std::size_t>(j * kSide + i)];
  return {mesh.origin[0] * 16.0 + v.x, mesh.origin[1] * 16.0 + v.y, mesh.origin[2] * 16.0 + v.z};
}

class Levels : public ::testing::Test {
 protected:
  using Ground = double (*)(int column, int row);

  void bake(int columns, int rows, double step, double north = 50, Ground ground = test::roughGround) {
    ground_ = ground;
    test::RasterRecipe recipe;
    recipe.north = north;
    recipe.columns = columns;
    recipe.rows = rows;
    recipe.step = step;
    recipe.value = [=](int c, int r, int) { return ground(c, r); };
    auto made = test::bakeInto(dir_, test::writeRaster(dir_ / "rough.tif", recipe));
    ASSERT_TRUE(made) << toString(made.findings());
    database_ = *made;
    posts_ = {recipe.west + step / 2,
              recipe.north - step * (rows - 0.5),
              step,
              step,
              static_cast<std::uint32_t>(columns),
              static_cast<std::uint32_t>(rows)};
  }
  double height(std::uint32_t row, std::uint32_t column) const {
    return static_cast<double>(
        static_cast<float>(ground_(static_cast<int>(column), static_cast<int>(posts_.rows - 1 - row))));
  }

  test::ScratchDir dir_;
  std::shared_ptr<const Database> database_;
  PostGrid posts_;
  Ground ground_ = nullptr;

  void checkSlopes();
};

TEST_F(Levels, havePostsInOnePlaceInAllTilesAndLevels) {
  bake(201, 150, 0.02);  // 290 km: the widest tiles need the coarser lattice
  const TerrainIndex& index = database_->index();
  ASSERT_GE(index.levels.size(), 3u);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::int64_t, 3>> known;
  TileMesh mesh;
  std::size_t again = 0;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    database_->buildTile(node, mesh);
    const TilePosts tile(index, posts_, node);
    for (std::uint32_t j = 0; j <= kTileCells; ++j)
      for (std::uint32_t i = 0; i <= kTileCells; ++i) {
        const auto at = absolute(mesh, j * kSide + i);
        const auto [entry, fresh] = known.insert({{tile.row(j), tile.column(i)}, at});
        if (!fresh) ++again;
        ASSERT_EQ(entry->second, at) << "node " << node << " vertex " << i << ", " << j;
      }
  }
  EXPECT_EQ(known.size(), 201u * 150);
  EXPECT_GT(again, 3000u);
}

TEST_F(Levels, boundsHoldAllThatIsDrawnBelow) {
  bake(140, 99, 0.001);
  const TerrainIndex& index = database_->index();
  TileMesh mesh;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    database_->buildTile(node, mesh);
    std::uint32_t holder = node;
    while (holder != TerrainIndex::kNone) {
      const Box& box = index.bounds[holder];
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const Vec3 p = place(mesh, i, j);
          ASSERT_TRUE(p.x >= box.minX && p.x <= box.maxX && p.y >= box.minY && p.y <= box.maxY &&
                      p.z >= box.minZ && p.z <= box.maxZ)
              << "node " << node << " in " << holder;
        }
      holder = index.parent[holder];
    }
  }
}

/// The two triangles of a cell as the index's comment puts them.
std::array<std::array<std::array<int, 2>, 3>, 2> trianglesOf(int i, int j) {
  if ((i + j) % 2 == 0)
    return {{{{{i, j}, {i + 1, j}, {i + 1, j + 1}}}, {{{i, j}, {i + 1, j + 1}, {i, j + 1}}}}};
  return {{{{{i, j}, {i + 1, j}, {i, j + 1}}}, {{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}}}};
}

/// Distance along `up` from `p` to a triangle, or none where the line misses it.
std::optional<double> alongUp(Vec3 p, Vec3 up, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  const double facing = dot(n, up);
  if (facing == 0) return {};
  const double t = dot(n, a - p) / facing;
  const Vec3 hit = p + up * t;
  const double slack = -1e-6 * length(n);
  const Vec3 unit = n * (1 / length(n));
  if (dot(cross(b - a, hit - a), unit) * length(n) / length(n) < slack) return {};
  if (dot(cross(c - b, hit - b), unit) < slack || dot(cross(a - c, hit - c), unit) < slack) return {};
  return t;
}

TEST_F(Levels, errorIsTheLargestDistanceOfAPostByBruteForce) {
  bake(97, 81, 0.0008);
  const TerrainIndex& index = database_->index();
  const GeographicLib::LocalCartesian oracle(index.frame.origin().latitude.value(),
                                             index.frame.origin().longitude.value(), 0);
  TileMesh mesh;
  std::vector<double> m(9);
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    database_->buildTile(node, mesh);
    const TilePosts tile(index, posts_, node);
    const auto stride = static_cast<int>(1u << tile.level);
    double worst = 0;
    for (std::uint32_t r = tile.row(0); r <= tile.row(kTileCells); ++r)
      for (std::uint32_t c = tile.column(0); c <= tile.column(kTileCells); ++c) {
        Vec3 p;
        oracle.Forward(posts_.latitude(r), posts_.longitude(c), height(r, c), p.x, p.y, p.z, m);
        const Vec3 up{m[2], m[5], m[8]};
        double nearest = 1e9;
        const int i0 = static_cast<int>(c - tile.column(0)) / stride,
                  j0 = static_cast<int>(r - tile.row(0)) / stride;
        for (int j = std::max(0, j0 - 1); j <= std::min<int>(kTileCells - 1, j0 + 1); ++j)
          for (int i = std::max(0, i0 - 1); i <= std::min<int>(kTileCells - 1, i0 + 1); ++i)
            for (const auto& t : trianglesOf(i, j))
              if (const auto d = alongUp(p, up, place(mesh, t[0][0], t[0][1]), place(mesh, t[1][0], t[1][1]),
                                         place(mesh, t[2][0], t[2][1])))
                nearest = std::min(nearest, std::abs(*d));
        // Posts of the outline may lie a hair beside the outermost triangle.
        if (nearest < 1e8) worst = std::max(worst, nearest);
      }
    EXPECT_GE(index.errorM[node], worst) << "node " << node;
    double below = 0;
    for (const std::uint32_t child : index.children[node])
      if (child != TerrainIndex::kNone) below = std::max<double>(below, index.errorM[child]);
    EXPECT_GE(index.errorM[node], below);
    // No more than the bounds for bend and rounding above what is there.
    EXPECT_LE(index.errorM[node], std::max(worst, below) * 1.001 + 0.2) << "node " << node;
  }
}

/// Rise over run against the vertical at one of its corners.
double slopeOf(Vec3 a, Vec3 b, Vec3 c, Vec3 up) {
  const Vec3 n = cross(b - a, c - a);
  const double along = std::abs(dot(n, up)), all = length(n);
  return std::sqrt(std::max(0.0, all * all - along * along)) / along;
}

void Levels::checkSlopes() {
  const TerrainIndex& index = database_->index();
  const GeographicLib::LocalCartesian oracle(index.frame.origin().latitude.value(),
                                             index.frame.origin().longitude.value(), 0);
  TileMesh mesh;
  std::vector<double> m(9);
  double steepest = 0, loosest = 0;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    database_->buildTile(node, mesh);
    const TilePosts tile(index, posts_, node);
    const auto check = [&](const std::array<std::array<int, 2>, 3>& t) {
      std::array<std::array<std::uint32_t, 2>, 3> at;
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = {tile.column(static_cast<std::uint32_t>(t[k][0])),
                 tile.row(static_cast<std::uint32_t>(t[k][1]))};
      if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) return;
      const Vec3 a = place(mesh, t[0][0], t[0][1]), b = place(mesh, t[1][0], t[1][1]),
                 c = place(mesh, t[2][0], t[2][1]);
      double x, y, z;
      oracle.Forward(posts_.latitude(at[0][1]), posts_.longitude(at[0][0]), 0, x, y, z, m);
      const Vec3 up{m[2], m[5], m[8]};
      // Clamped flat, on one parallel or meridian.
      if ((at[0][0] == at[1][0] && at[1][0] == at[2][0]) || (at[0][1] == at[1][1] && at[1][1] == at[2][1]))
        return;
      const double slope = slopeOf(a, b, c, up);
      if (!(slope < 100)) return;
      steepest = std::max(steepest, slope);
      for (std::uint32_t holder = node; holder != TerrainIndex::kNone; holder = index.parent[holder])
        ASSERT_LE(slope, index.slopeMax[holder]) << node;
      for (const std::uint32_t beside : index.neighbours[node])
        if (beside != TerrainIndex::kNone) {
          ASSERT_LE(slope, index.slopeMax[beside]);
        }
      for (const auto& [i, j] : t) {
        const std::uint8_t byte = mesh.vertices[static_cast<std::size_t>(j * kSide + i)].slope;
        if (byte == 255) continue;
        ASSERT_LE(slope, byte / 16.0) << "node " << node << " vertex " << i << ", " << j;
        loosest = std::max(loosest, byte / 16.0);
      }
    };
    for (int j = 0; j < static_cast<int>(kTileCells); ++j)
      for (int i = 0; i < static_cast<int>(kTileCells); ++i)
        for (const auto& t : trianglesOf(i, j)) check(t);
    constexpr int kLast = static_cast<int>(kTileCells);
    for (int k = 0; k < kLast; k += 2) {
      check({{{k, 0}, {k + 2, 0}, {k + 1, 1}}});
      check({{{k, kLast}, {k + 2, kLast}, {k + 1, kLast - 1}}});
      check({{{0, k}, {0, k + 2}, {1, k + 1}}});
      check({{{kLast, k}, {kLast, k + 2}, {kLast - 1, k + 1}}});
    }
  }
  EXPECT_GT(steepest, 0.5);
  // The index's largest is some triangle's, not a wild guess.
  EXPECT_LE(*std::max_element(index.slopeMax.begin(), index.slopeMax.end()), steepest * 1.02 + 0.05);
}

TEST_F(Levels, slopesBoundEveryTriangleWithEitherBorder) {
  bake(131, 75, 0.0007);
  checkSlopes();
}

TEST_F(Levels, slopesBoundBordersThatAreSteepOnlyWhereStitched) {
  // Furrows along the parallels, in the north where columns are close: a border without its odd posts stands
  // on the crests, and the fan's centre lies in the furrow beside it.
  bake(131, 99, 0.001, 80.05, [](int, int row) { return row % 2 == 0 ? 40.0 : 0.0; });
  checkSlopes();
  // Deep only west of the first tile's eastern border: no other border speaks for that one.
  bake(131, 99, 0.001, 80.05, [](int column, int row) {
    return row % 2 == 0 ? 40.0 : column >= 20 && column <= 32 ? 0.0 : 20.0;
  });
  checkSlopes();
}

TEST_F(Levels, linkParentsChildrenAndNeighbours) {
  bake(300, 140, 0.0005);
  const TerrainIndex& index = database_->index();
  ASSERT_EQ(index.levels.front().columns, 10u);
  ASSERT_EQ(index.levels.front().rows, 5u);
  ASSERT_EQ(index.levels.back().columns, 1u);
  std::size_t roots = 0;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    if (index.parent[node] == TerrainIndex::kNone) ++roots;
    for (std::size_t k = 0; k < 4; ++k) {
      if (const std::uint32_t child = index.children[node][k]; child != TerrainIndex::kNone) {
        EXPECT_EQ(index.parent[child], node);
        EXPECT_EQ(index.level[child] + 1, index.level[node]);
      }
      if (const std::uint32_t beside = index.neighbours[node][k]; beside != TerrainIndex::kNone) {
        EXPECT_EQ(index.neighbours[beside][k ^ 1], node);
        EXPECT_EQ(index.level[beside], index.level[node]);
      }
    }
  }
  EXPECT_EQ(roots, 1u);
}

TEST(PostGrid, countsAPlacesColumnFromItsMiddle) {
  struct Case {
    double west, longitude, column;
  };
  // 43,200 columns of half a minute's arc are the whole earth; 1,201 reach over the date line.
  for (const Case c :
       {Case{-180, 90, 32400}, Case{-180, -179, 120}, Case{-180, 179, 43080}, Case{0, -90, 32400}}) {
    const PostGrid whole{c.west, -90, 1 / 120.0, 1 / 120.0, 43200, 21601};
    EXPECT_NEAR(whole.columnOf(c.longitude), c.column, 1e-6) << c.west << ' ' << c.longitude;
  }
  for (const Case c : {Case{175, -179, 720}, Case{175, 181, 720}, Case{-185, 181, 720}, Case{175, 174, -120},
                       Case{175, -174, 1320}}) {
    const PostGrid across{c.west, 10, 1 / 120.0, 1 / 120.0, 1201, 101};
    EXPECT_NEAR(across.columnOf(c.longitude), c.column, 1e-6) << c.west << ' ' << c.longitude;
    EXPECT_NEAR(across.rowOf(10.5), 60, 1e-9);
  }
}

TEST(MakeLevels, givesTheSmallestGridOneTile) {
  const TerrainIndex index = makeLevels({0, 0, 1, 1, 2, 2});
  EXPECT_EQ(index.size(), 1u);
  EXPECT_EQ(index.levels.size(), 1u);
  EXPECT_EQ(makeLevels({0, 0, 1, 1, 33, 33}).size(), 1u);
  EXPECT_EQ(makeLevels({0, 0, 1, 1, 34, 33}).size(), 3u);
}

}  // namespace
}  // namespace trimtab::terrain
