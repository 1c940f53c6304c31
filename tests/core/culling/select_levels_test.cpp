#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "random_index.h"

namespace trimtab {
namespace {

constexpr std::uint32_t kTiles = 32;
constexpr double kPixelsPerRadian = 1100;

/// The cut as a grid of finest tiles: how many tiles of the cut cover each, and the level of the last that
/// did.
struct Grid {
  std::array<int, kTiles * kTiles> covered{}, level{};
  int levelAt(int column, int row) const {
    return level[static_cast<std::size_t>(row) * kTiles + static_cast<std::size_t>(column)];
  }
};
struct Square {
  int column, row, size;  ///< finest tiles
};
Square squareOf(const TerrainIndex& index, std::uint32_t node) {
  const int level = index.level[node];
  const TerrainIndex::Level& l = index.levels[static_cast<std::size_t>(level)];
  const std::uint32_t i = node - l.firstNode;
  const int size = 1 << level;
  return {static_cast<int>(i % l.columns) * size, static_cast<int>(i / l.columns) * size, size};
}
Grid gridOf(const TerrainIndex& index, const LevelCut& cut) {
  Grid grid;
  for (const TileDraw& tile : cut.tiles) {
    const Square s = squareOf(index, tile.node);
    for (int row = s.row; row < s.row + s.size; ++row)
      for (int column = s.column; column < s.column + s.size; ++column) {
        const std::size_t cell = static_cast<std::size_t>(row) * kTiles + static_cast<std::size_t>(column);
        ++grid.covered[cell];
        grid.level[cell] = index.level[tile.node];
      }
  }
  return grid;
}

class LevelCutOf : public testing::TestWithParam<unsigned> {
 protected:
  TerrainIndex index = test::randomIndex(kTiles, GetParam());
  std::mt19937 random{GetParam() * 7919 + 1};
  Vec3 randomEye() {
    std::uniform_real_distribution<double> place(-5000, 37000), height(0, 9000);
    return {place(random), place(random), height(random)};
  }
};

TEST_P(LevelCutOf, coversEveryFinestTileExactlyOnce) {
  LevelCut cut;
  for (int i = 0; i < 40; ++i) {
    selectLevels(index, randomEye(), {2, 1.0 + i % 3, kPixelsPerRadian}, cut);
    const Grid grid = gridOf(index, cut);
    for (const int n : grid.covered) ASSERT_EQ(n, 1);
  }
}

TEST_P(LevelCutOf, differsByAtMostOneLevelBetweenNeighboursAndTellsWhichSideIsCoarser) {
  LevelCut cut;
  int coarserSides = 0;
  for (int i = 0; i < 40; ++i) {
    selectLevels(index, randomEye(), {1, 1, kPixelsPerRadian}, cut);
    const Grid grid = gridOf(index, cut);
    for (const TileDraw& tile : cut.tiles) {
      const Square s = squareOf(index, tile.node);
      const int own = index.level[tile.node];
      for (int side = 0; side < 4; ++side) {
        bool coarser = false;
        for (int k = 0; k < s.size; ++k) {
          const int column = side == 0 ? s.column - 1 : side == 1 ? s.column + s.size : s.column + k;
          const int row = side == 2 ? s.row - 1 : side == 3 ? s.row + s.size : s.row + k;
          if (column < 0 || row < 0 || column >= static_cast<int>(kTiles) || row >= static_cast<int>(kTiles))
            continue;
          const int other = grid.levelAt(column, row);
          ASSERT_LE(std::abs(other - own), 1);
          coarser |= other > own;
        }
        ASSERT_EQ((tile.border.bits >> side & 1) != 0, coarser);
        coarserSides += coarser;
      }
    }
  }
  EXPECT_GT(coarserSides, 100) << "the eyes never met a change of level";
}

TEST_P(LevelCutOf, holdsTheErrorWhereTheDataAllow) {
  LevelCut cut;
  for (int i = 0; i < 40; ++i) {
    const Vec3 eye = randomEye();
    const double limit = 0.5 + 0.25 * i, scale = 1 + i % 4;
    selectLevels(index, eye, {limit, scale, kPixelsPerRadian}, cut);
    for (const TileDraw& tile : cut.tiles) {
      if (index.level[tile.node] == 0) continue;
      const Box& b = index.bounds[tile.node];
      const Vec3 nearest{std::clamp(eye.x, double{b.minX}, double{b.maxX}),
                         std::clamp(eye.y, double{b.minY}, double{b.maxY}),
                         std::clamp(eye.z, double{b.minZ}, double{b.maxZ})};
      ASSERT_LE(index.errorM[tile.node] * kPixelsPerRadian,
                limit * scale * length(eye - nearest) * (1 + 1e-9));
    }
  }
}

TEST_P(LevelCutOf, takesDistancesApartOrTogetherByTheSpread) {
  // The twin has the errors that give the spread distances without a spread.
  LevelCut cut, expected, plain;
  std::size_t changed = 0;
  for (const double spread : {0.5, 0.8, 1.5, 3.0}) {
    const double limit = 0.4 * 1.5, from = 2000;
    TerrainIndex twin = index;
    for (float& error : twin.errorM) {
      const double distance = double{error} * kPixelsPerRadian / limit;
      error = static_cast<float>(from * std::pow(distance / from, spread) * limit / kPixelsPerRadian);
    }
    for (int i = 0; i < 20; ++i) {
      const Vec3 eye = randomEye();
      selectLevels(index, eye, {0.4, 1.5, kPixelsPerRadian, spread, from}, cut);
      selectLevels(twin, eye, {0.4, 1.5, kPixelsPerRadian}, expected);
      selectLevels(index, eye, {0.4, 1.5, kPixelsPerRadian}, plain);
      ASSERT_EQ(*cut.nodes, *expected.nodes) << spread;
      changed += *cut.nodes != *plain.nodes;
    }
  }
  EXPECT_GT(changed, 40u);
}

TEST(CutRule, spreadKeepsOneDistanceAndTheLimits) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double spread : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    EXPECT_NEAR(spreadSquared(5000.0 * 5000, spread, 5000), 5000.0 * 5000, 1e-6);
    EXPECT_NEAR(std::sqrt(spreadSquared(4e8, spread, 5000)), 5000 * std::pow(4, spread), 1e-6);
    EXPECT_EQ(spreadSquared(0, spread, 5000), 0);
    EXPECT_EQ(spreadSquared(inf, spread, 5000), inf);
    EXPECT_TRUE(std::isnan(spreadSquared(nan, spread, 5000)));
    const CutRule rule{2, 1, 1000, spread, 5000};
    EXPECT_TRUE(rule.isTooCoarse(1e-6, 0, rule.limit())) << "an eye inside the box";
    EXPECT_FALSE(rule.isTooCoarse(0, 0, rule.limit()));
    EXPECT_FALSE(rule.isTooCoarse(1e6, nan, rule.limit()));
    EXPECT_FALSE(rule.isTooCoarse(1e6, inf, rule.limit()));
    EXPECT_EQ(rule.errorOverDistance(), spread == 1 ? 0.002 : 0);
  }
}

TEST_P(LevelCutOf, drawsInAnOrderThatDependsOnTheTerrainAlone) {
  LevelCut first, second;
  std::map<std::uint32_t, std::size_t> place;
  for (int i = 0; i < 20; ++i) {
    selectLevels(index, randomEye(), {2, 1, kPixelsPerRadian}, first);
    selectLevels(index, randomEye(), {2, 1, kPixelsPerRadian}, second);
    place.clear();
    for (std::size_t k = 0; k < first.tiles.size(); ++k) place[first.tiles[k].node] = k;
    std::size_t last = 0;
    for (const TileDraw& tile : second.tiles)
      if (const auto found = place.find(tile.node); found != place.end()) {
        ASSERT_GE(found->second, last);
        last = found->second;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Terrains, LevelCutOf, testing::Range(1u, 6u));

TEST(LevelCut, isTheRootAloneForAnEyeThatIsNotANumber) {
  const TerrainIndex index = test::randomIndex(8, 3);
  LevelCut cut;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    selectLevels(index, {bad, 0, 0}, {2, 1, kPixelsPerRadian}, cut);
    ASSERT_EQ(cut.tiles.size(), 1u);
    EXPECT_EQ(index.parent[cut.tiles[0].node], TerrainIndex::kNone);
  }
}

TEST(LevelCut, isCoarserForALargerScaleAndEmptyForAnEmptyTerrain) {
  const TerrainIndex index = test::randomIndex(32, 4);
  LevelCut cut;
  std::size_t last = index.size();
  for (const double scale : {1.0, 2.0, 4.0, 8.0, 64.0}) {
    selectLevels(index, {16000, 16000, 1500}, {1, scale, kPixelsPerRadian}, cut);
    EXPECT_LE(cut.tiles.size(), last);
    last = cut.tiles.size();
  }
  EXPECT_LT(last, 200u);
  selectLevels(TerrainIndex{}, {}, {1, 1, 1}, cut);
  EXPECT_TRUE(cut.tiles.empty());
}

}  // namespace
}  // namespace trimtab
