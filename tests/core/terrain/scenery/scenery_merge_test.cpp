#include "trimtab/terrain/scenery/merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/terrain/bake/heights.h"
#include "scenery_grid.h"
#include "scenery_tiles.h"
#include "tests/core/terrain/grid/fill_grid.h"
#include "trimtab/terrain/scenery/import.h"
#include "trimtab/terrain/scenery/made.h"
#include "trimtab/terrain/static_lod/lattice.h"
#include "trimtab/terrain/static_lod/static_lod.h"

/// Scenery and elevation in one terrain.
namespace trimtab {
namespace {

using terrain::HeightGrid;
using terrain::Lattice;
using terrain::SceneryMesh;

HeightGrid elevationOver(double west, double south, double east, double north, double step,
                         const std::function<double(double longitude, double latitude)>& height) {
  HeightGrid grid;
  grid.posts = {west,
                south,
                step,
                step,
                static_cast<std::uint32_t>(std::lround((east - west) / step)) + 1,
                static_cast<std::uint32_t>(std::lround((north - south) / step)) + 1};
  for (std::uint32_t r = 0; r < grid.posts.rows; ++r)
    for (std::uint32_t c = 0; c < grid.posts.columns; ++c)
      grid.heights.push_back(static_cast<float>(height(grid.posts.longitude(c), grid.posts.latitude(r))));
  return grid;
}

/// What is left open between the tiles of a terrain.
struct Seams {
  std::size_t madeTiles = 0, madeEdges = 0;  ///< of them: edges on a border of a made tile
  std::size_t open = 0;                      ///< of those, such that no other tile has, inside the rim
  std::size_t slits = 0;                     ///< the same, but shorter than 5 cm: scenery has some of its own
  std::size_t rim = 0;                       ///< and on the rim
};
Seams seamsOf(std::span<const SceneryMesh> meshes, const std::set<std::string>& scenery,
              const terrain::Rectangle& rim) {
  GeodeticPosition middle = toGeodetic(meshes[0].vertices[0]);
  middle.height = Metres{0};
  const LocalFrame frame(middle);
  const auto lattice = terrain::toLattice(meshes, frame);
  EXPECT_TRUE(lattice) << toString(lattice.findings());
  Seams seams;
  struct Edge {
    Lattice a, b;
    int way;
    bool made;
  };
  std::vector<Edge> edges;
  for (const terrain::LatticeTile& tile : lattice->tiles) {
    const bool isMade = !scenery.contains(tile.name);
    seams.madeTiles += isMade;
    for (const auto& t : tile.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Lattice &a = tile.vertices[t[k]], &b = tile.vertices[t[(k + 1) % 3]];
        edges.push_back(a < b ? Edge{a, b, 1, isMade} : Edge{b, a, -1, isMade});
      }
    if (!isMade) continue;
    for (const auto& t : tile.triangles)
      EXPECT_GT(terrain::orientation(tile.vertices[t[0]], tile.vertices[t[1]], tile.vertices[t[2]]), 0)
          << tile.name;
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& s, const Edge& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; });
  const auto onRim = [&](const Lattice& p) {
    const GeodeticPosition g = frame.toGeodetic(p.metres());
    const double x = g.longitude.value(), y = g.latitude.value();
    return std::min({x - rim.west, rim.east - x, y - rim.south, rim.north - y});
  };
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    int all = 0, made = 0;
    for (end = i; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b; ++end) {
      all += edges[end].way;
      if (edges[end].made) made += edges[end].way;
    }
    if (made == 0) continue;
    ++seams.madeEdges;
    if (all == 0) continue;
    const Lattice &a = edges[i].a, &b = edges[i].b;
    // A rim that cuts a tile's border ends at the last vertex before it.
    if (std::max(onRim(a), onRim(b)) < 0.01)
      ++seams.rim;
    else
      ++(std::hypot(a.x - b.x, a.y - b.y) * Lattice::kStepM < 0.05 ? seams.slits : seams.open);
  }
  return seams;
}

std::set<std::string> namesOf(const terrain::Scenery& scenery) {
  std::set<std::string> names;
  for (const SceneryMesh& mesh : scenery.tiles) names.insert(mesh.name);
  return names;
}

/// As a bake does it.
struct Merged {
  std::vector<SceneryMesh> meshes;
  terrain::SceneryCounts counts;
  HeightGrid grid;  ///< no voids left
};
Result<Merged> merged(terrain::Scenery scenery, const HeightGrid& elevation, std::optional<Metres> distance) {
  Merged all;
  terrain::SceneryCatalogue tiles(std::move(scenery.tiles));
  all.counts = tiles.counts();
  const auto posts = terrain::postsOfBoth(tiles, elevation.posts, distance);
  if (!posts) return posts.findings();
  auto heights = terrain::SceneryHeights::open(tiles, *posts, {}, terrain::sourceOf(elevation));
  if (!heights) return heights.findings();
  all.grid.posts = *posts;
  all.grid.heights.resize(posts->size());
  if (auto read = (*heights)->readRows(0, posts->rows, all.grid.heights); !read) return read.findings();
  test::fillVoids(all.grid);
  const terrain::GridHeights baked(all.grid);
  const auto where = terrain::elevationsPart(*posts, elevation.posts);
  if (auto made = terrain::makeTiles(tiles, baked, where, {}); !made) return made.findings();
  auto meshes = tiles.takeAll();
  if (!meshes) return meshes.findings();
  all.meshes = std::move(meshes).value();
  return Result<Merged>(std::move(all));
}

terrain::Scenery oneTile() {
  test::TileRecipe recipe;
  recipe.cells = 24;
  recipe.heightM = [](double x, double y) { return 300 + 80 * std::sin(60 * x) * std::cos(80 * y); };
  auto mesh = terrain::parseBtg(
      test::gridTile(recipe), std::to_string(terrain::bucketAt(Degrees{50.55}, Degrees{7.1}).index) + ".btg");
  terrain::Scenery scenery;
  scenery.tiles.push_back(std::move(mesh).value());
  return scenery;
}

TEST(SceneryMerge, closesTheSurfaceAroundATile) {
  auto scenery = oneTile();
  const auto names = namesOf(scenery);
  const auto elevation = elevationOver(
      6.6, 50.3, 7.6, 50.75, 0.001, [](double x, double y) { return 320 + 60 * std::sin(60 * x + 70 * y); });
  const auto both = merged(std::move(scenery), elevation, {});
  ASSERT_TRUE(both) << toString(both.findings());
  const auto& meshes = both->meshes;
  // 5 columns of buckets, cut to 1 degree, by 4 rows, cut; but for the one that is there.
  EXPECT_EQ(meshes.size(), 20U);
  const Seams seams = seamsOf(meshes, names, {6.6, 50.3, 7.6, 50.75});
  EXPECT_EQ(seams.madeTiles, 19U);
  EXPECT_EQ(seams.open, 0U);
  EXPECT_GT(seams.rim, 100U);
  EXPECT_GT(seams.madeEdges, seams.rim + 90);  // the tile's own border has 96 edges
  EXPECT_EQ(both->counts.tiles, 1U);
  for (const float h : both->grid.heights) ASSERT_TRUE(std::isfinite(h));

  // And the trees of it: at every level the same borders, with no open edge but the rim.
  const LocalFrame frame({Degrees{50.5}, Degrees{7.1}, Metres{0}});
  const auto trees = terrain::buildStaticLod(meshes, frame, {});
  ASSERT_TRUE(trees) << toString(trees.findings());
  EXPECT_EQ((*trees)->tiles.size(), 20U);
}

TEST(SceneryMerge, hasNoStepWhereTheSourcesDiffer) {
  auto scenery = oneTile();
  // 40 m above what the tile has at its border, and as steep as it.
  const auto elevation = elevationOver(6.8, 50.4, 7.5, 50.75, 0.0005, [](double x, double y) {
    return 340 + 80 * std::sin(60 * x) * std::cos(80 * y);
  });
  const auto both = merged(std::move(scenery), elevation, Metres{40});
  ASSERT_TRUE(both);
  const auto& posts = both->grid.posts;
  double steepest = 0, away = 0;
  std::size_t own = 0;
  for (std::uint32_t r = 0; r + 1 < posts.rows; ++r)
    for (std::uint32_t c = 0; c + 1 < posts.columns; ++c) {
      const float h = both->grid.heights[std::size_t{r} * posts.columns + c];
      const double east = both->grid.heights[std::size_t{r} * posts.columns + c + 1] - h,
                   north = both->grid.heights[std::size_t{r + 1} * posts.columns + c] - h;
      steepest = std::max({steepest, std::abs(east), std::abs(north)});
      const double x = posts.longitude(c), y = posts.latitude(r);
      if (x > 6.9 && x < 7.4 && y > 50.45 && y < 50.7) continue;
      away = std::max(away, std::abs(h - (340 + 80 * std::sin(60 * x) * std::cos(80 * y))));
      ++own;
    }
  // A post of 40 m of that relief rises by 3.2 m; a step would be 40.
  EXPECT_LT(steepest, 7);
  EXPECT_GT(own, 10000U);
  EXPECT_LT(away, 0.5) << "where no tile is near, elevation is as it was";
}

/// A coarse elevation of what the scenery covers and 0.1 degrees around, 7 m higher.
HeightGrid coarse(const std::vector<SceneryMesh>& meshes, double stepDegrees, double aroundDegrees) {
  const auto posts = terrain::sceneryPosts(meshes, Metres{500});
  const auto grid = test::rasterised(meshes, *posts);
  return elevationOver(
      posts->west - aroundDegrees, posts->south - aroundDegrees,
      posts->longitude(posts->columns - 1) + aroundDegrees, posts->latitude(posts->rows - 1) + aroundDegrees,
      stepDegrees, [&](double x, double y) {
        const double c = std::clamp((x - posts->west) / posts->stepLongitude, 0.0, posts->columns - 1.0),
                     r = std::clamp((y - posts->south) / posts->stepLatitude, 0.0, posts->rows - 1.0);
        const float h = grid->heights[static_cast<std::size_t>(std::lround(r)) * posts->columns +
                                      static_cast<std::size_t>(std::lround(c))];
        return std::isnan(h) ? 0.0 : h + 7.0;
      });
}

struct Real {
  const char* folder;
  std::vector<std::string> without;  ///< tiles left out, for elevation to stand in
  std::size_t made;
};
struct RealMerge : testing::TestWithParam<Real> {};

TEST_P(RealMerge, closesTheSurfaceBetweenBothKinds) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam().folder);
  auto scenery = terrain::readScenery(test::sharedDir() / "data" / GetParam().folder);
  ASSERT_TRUE(scenery);
  const HeightGrid elevation = coarse(scenery->tiles, 0.004, 0.1);
  std::erase_if((*scenery).tiles, [](const SceneryMesh& mesh) {
    const auto& without = GetParam().without;
    return std::find(without.begin(), without.end(), mesh.name) != without.end();
  });
  const auto names = namesOf(*scenery);
  const auto both = merged(std::move(scenery).value(), elevation, Metres{90});
  ASSERT_TRUE(both) << toString(both.findings());
  const auto& e = elevation.posts;
  const Seams seams =
      seamsOf(both->meshes, names, {e.west, e.south, e.longitude(e.columns - 1), e.latitude(e.rows - 1)});
  EXPECT_EQ(seams.madeTiles, GetParam().made);
  EXPECT_EQ(seams.open, 0U);
  EXPECT_LE(seams.slits, 1U);
  EXPECT_GT(seams.madeEdges, seams.rim + 1000);
  std::printf("%s: %zu tiles made, %zu border edges, %zu of them on the rim\n", GetParam().folder,
              seams.madeTiles, seams.madeEdges, seams.rim);
}

INSTANTIATE_TEST_SUITE_P(Sets, RealMerge,
                         testing::Values(Real{"fg-debian-iceland-reykjanes", {}, 56},
                                         Real{"fg-kansai-e135n35", {"5168979", "5168986", "5168987"}, 32}),
                         [](const auto& set) {
                           std::string name = set.param.folder;
                           std::erase_if(name,
                                         [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

}  // namespace
}  // namespace trimtab
