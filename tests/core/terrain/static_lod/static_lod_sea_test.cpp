#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/sea.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support.h"

namespace trimtab::terrain {
namespace {

/// Three buckets in a row from 135 E, 35.5 N; the middle one has no tile.
class OpenSea : public testing::Test {
 protected:
  OpenSea() {
    for (const double longitude : {135.1, 135.6}) {
      SceneryMesh tile;
      tile.name = std::to_string(bucketAt(Degrees{35.55}, Degrees{longitude}).index);
      tiles.push_back(tile);
    }
    grid.posts = {135, 35.5, 0.0025, 0.0025, 301, 51};
    grid.heights.assign(grid.posts.size(), 0.0f);
    auto empty = std::make_shared<StaticLodTerrain>();
    empty->index.frame = LocalFrame({Degrees{35.55}, Degrees{135.4}, Metres{0}});
    trees = empty;
  }
  std::vector<SceneryMesh> tiles;
  HeightGrid grid;
  std::shared_ptr<const StaticLodTerrain> trees;
};

TEST_F(OpenSea, fillsTheBucketWithoutATile) {
  const auto sea = withOpenSea(trees, tiles, GridHeights(grid));
  ASSERT_EQ(sea->tiles.size(), 1u);
  ASSERT_EQ(sea->index.roots, std::vector<std::uint32_t>{0});
  const StaticLodTile& tile = sea->tiles[0];
  EXPECT_EQ(tile.name, "sea-" + std::to_string(bucketAt(Degrees{35.55}, Degrees{135.35}).index));
  EXPECT_EQ(sea->materials, std::vector<std::string>{"Ocean"});
  EXPECT_EQ(sea->index.nodes[0].triangles * 3, tile.indices.size());
  EXPECT_EQ(sea->counts.faces, sea->index.nodes[0].triangles);

  const Box& box = sea->index.bounds[0];
  double west = 1e9, east = -1e9, area = 0;
  std::size_t level = 0;
  std::vector<Vec3> places;
  for (const StaticLodVertex& v : tile.vertices) {
    const Vec3 p{16.0 * tile.origin[0] + v.x, 16.0 * tile.origin[1] + v.y, 16.0 * tile.origin[2] + v.z};
    EXPECT_EQ(p.x * 256, std::round(p.x * 256));
    EXPECT_TRUE(p.x >= box.minX && p.x <= box.maxX && p.y >= box.minY && p.y <= box.maxY && p.z >= box.minZ &&
                p.z <= box.maxZ);
    const GeodeticPosition g = sea->index.frame.toGeodetic(p);
    west = std::min(west, g.longitude.value());
    east = std::max(east, g.longitude.value());
    level += std::abs(g.height.value()) < 0.01;
    EXPECT_GT(g.height.value(), -13);
    places.push_back(p);
  }
  EXPECT_LT(west, 135.25) << "an apron reaches under the neighbours";
  EXPECT_GT(east, 135.5);
  EXPECT_EQ(level, 17u * 17);
  for (std::size_t i = 0; i < tile.indices.size(); i += 3) {
    const Vec3 n = cross(places[tile.indices[i + 1]] - places[tile.indices[i]],
                         places[tile.indices[i + 2]] - places[tile.indices[i]]);
    EXPECT_GT(n.z, 0) << "it faces up";
    area += 0.5 * n.z;
  }
  EXPECT_NEAR(area / (0.128 * 0.253 * 110960 * 90670), 1, 0.01);
}

TEST_F(OpenSea, isLeftOutWhereLandOrATileIs) {
  grid.heights[25 * 301 + 150] = 12;
  EXPECT_EQ(withOpenSea(trees, tiles, GridHeights(grid)), trees) << "land in the middle of the bucket";
  grid.heights.assign(grid.posts.size(), 0.0f);
  SceneryMesh tile;
  tile.name = std::to_string(bucketAt(Degrees{35.55}, Degrees{135.35}).index);
  tiles.push_back(tile);
  EXPECT_EQ(withOpenSea(trees, tiles, GridHeights(grid)), trees);
}

TEST_F(OpenSea, staysInsideTheTerrain) {
  grid.posts.columns = 160;  // to 135.4: the bucket reaches past it
  grid.heights.assign(grid.posts.size(), 0.0f);
  EXPECT_EQ(withOpenSea(trees, tiles, GridHeights(grid)), trees);
}

TEST_F(OpenSea, goesOnBeyondTheDateLine) {
  for (const double turn : {0.0, -360.0}) {
    // The middle bucket lies from 180 W on; the grid may count from either side.
    tiles.clear();
    for (const double longitude : {179.9, -179.6}) {
      SceneryMesh tile;
      tile.name = std::to_string(bucketAt(Degrees{35.55}, Degrees{longitude}).index);
      tiles.push_back(tile);
    }
    grid.posts.west = 179.75 + turn;
    const auto sea = withOpenSea(trees, tiles, GridHeights(grid));
    ASSERT_EQ(sea->tiles.size(), 1u) << turn;
    EXPECT_EQ(sea->tiles[0].name, "sea-" + std::to_string(bucketAt(Degrees{35.55}, Degrees{-179.9}).index));
    grid.heights[25 * 301 + 150] = 12;
    EXPECT_EQ(withOpenSea(trees, tiles, GridHeights(grid)), trees) << "land in the middle of the bucket";
    grid.heights.assign(grid.posts.size(), 0.0f);
  }
}

TEST_F(OpenSea, isWrittenAndReadAsAnyTree) {
  const test::ScratchDir dir;
  const auto sea = withOpenSea(trees, tiles, GridHeights(grid));
  const auto written = writeStaticLod(dir / "trees.bin", *sea);
  ASSERT_TRUE(written) << toString(written.findings());
  const auto read = readStaticLod(dir / "trees.bin");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ((*read)->tiles[0].indices, sea->tiles[0].indices);
}

}  // namespace
}  // namespace trimtab::terrain
