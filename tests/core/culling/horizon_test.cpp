#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ridge_ground.h"

namespace trimtab {
namespace {

using Ground = test::RidgeGround;

struct Tally {
  std::size_t hidden = 0, tiles = 0, wrong = 0, asked = 0;
};

/// Points of tiles that are said to be hidden, asked of the ground itself; tiles in the ground's order.
Tally fly(const Ground& ground, const std::vector<HorizonTile>& tiles, int eyes,
          const Horizon::Settings& settings, unsigned seed) {
  // The places do not depend on what is found hidden.
  std::mt19937 random(seed), randomPlace(seed + 1);
  std::uniform_real_distribution<double> unit(0, 1), place(0, 1);
  Horizon horizon;
  Tally tally;
  for (int i = 0; i < eyes; ++i) {
    Vec3 eye{ground.sideM() * (0.1 + 0.8 * place(randomPlace)),
             ground.sideM() * (0.1 + 0.8 * place(randomPlace)), 0};
    eye.z = ground.heightAt(eye.x, eye.y) + 5 * std::pow(300.0, place(randomPlace) * place(randomPlace));
    horizon.build(eye, tiles, settings);
    EXPECT_EQ(horizon.hidden().size(), tiles.size());
    std::size_t hidden = 0;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      if (horizon.hidden()[t] == 0) continue;
      ++hidden;
      const TileRelief& r = ground.reliefs()[t];
      for (int k = 0; k < 40; ++k) {
        Vec3 p;
        if (k < 20) {
          const auto post = static_cast<std::size_t>(unit(random) * double(r.x.size()));
          p = r.origin + Vec3{r.x[post], r.y[post], r.z[post]};
        } else {
          const double x = r.origin.x + double{r.bounds.minX} +
                           unit(random) * (double{r.bounds.maxX} - r.bounds.minX),
                       y = r.origin.y + double{r.bounds.minY} +
                           unit(random) * (double{r.bounds.maxY} - r.bounds.minY);
          p = {x, y, ground.heightAt(x, y)};
        }
        ++tally.asked;
        tally.wrong += !ground.isCovered(eye, p);
      }
    }
    EXPECT_EQ(hidden, horizon.hiddenCount());
    tally.hidden += hidden;
    tally.tiles += tiles.size();
  }
  return tally;
}

Tally fly(const Ground& ground, int eyes, const Horizon::Settings& settings, unsigned seed) {
  return fly(ground, ground.tiles(), eyes, settings, seed);
}

std::vector<HorizonTile> tilesOf(const std::vector<MeshRelief>& meshes) {
  std::vector<HorizonTile> tiles;
  for (const MeshRelief& mesh : meshes) tiles.push_back({.mayOcclude = mesh.upright, .mesh = &mesh});
  return tiles;
}

TEST(Horizon, hidesOnlyWhatTheGroundItselfHides) {
  for (const int columns : {16, 128, 1024}) {
    const Ground ground(10, 16, 60, 1 + static_cast<unsigned>(columns));
    const Tally tally = fly(ground, 60, {.columns = columns}, 3);
    EXPECT_EQ(tally.wrong, 0u) << columns;
    EXPECT_GT(tally.asked, 1000u) << columns;
    std::printf("%d columns a quarter: %zu of %zu tiles hidden\n", columns, tally.hidden, tally.tiles);
  }
}

// Without this, the test above might pass because nothing can go wrong where it looks.
TEST(Horizon, isSeenToFailWhereLinesReachTooHigh) {
  const Ground ground(10, 16, 60, 2);
  EXPECT_GT(fly(ground, 60, {.columns = 16, .raised = true}, 3).wrong, 0u);
}

TEST(Horizon, hidesMoreWithMoreColumns) {
  const Ground ground(12, 16, 60, 5);
  std::size_t last = 0;
  for (const int columns : {16, 64, 512, 4096}) {
    const std::size_t hidden = fly(ground, 20, {.columns = columns}, 7).hidden;
    EXPECT_GT(hidden, last);
    last = hidden;
  }
}

// Parts and blocks of posts end where the tile does.
TEST(Horizon, hidesOnlyWhatTheGroundItselfHidesWhateverTheTilesSize) {
  for (const int cells : {5, 6, 9, 15, 31}) {
    const Ground ground(160 / cells, cells, 60, 3);
    const Tally tally = fly(ground, 40, {}, 5);
    EXPECT_EQ(tally.wrong, 0u) << cells;
    EXPECT_GT(tally.hidden, 100u) << cells;
  }
}

/// A level tile.
TileRelief plateau(double x0, double x1, double y0, double y1, double z) {
  TileRelief relief;
  relief.side = 9;
  relief.origin = {x0, y0, z};
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      relief.x.push_back(static_cast<float>((x1 - x0) * x / 8));
      relief.y.push_back(static_cast<float>((y1 - y0) * y / 8));
      relief.z.push_back(0);
    }
  relief.finish(4);
  return relief;
}

TEST(Horizon, hidesNothingByLinesThatAreBehindIt) {
  // Begins nearer to the eye than the one beside it, and is seen behind that.
  const TileRelief high = plateau(-100, 12000, 1000, 3000, 600), before = plateau(2000, 2400, 600, 1000, 0),
                   behind = plateau(14000, 14400, 4000, 4400, 0);
  const std::vector<HorizonTile> tiles{{&high, true}, {&before, true}, {&behind, true}};
  for (const bool noWaiting : {false, true}) {
    Horizon horizon;
    horizon.build({0, 0, 100}, tiles, {.noWaiting = noWaiting});
    EXPECT_EQ(horizon.hidden(), (std::vector<std::uint8_t>{0, 0, 1}));
  }
}

// What waits until a test asks for it is not missing where it would have hidden something.
TEST(Horizon, hidesByLinesThatWaitAsMuchAsByThoseThatDoNot) {
  const Ground ground(12, 16, 60, 5);
  const std::vector<MeshRelief> meshes = ground.meshes(4);
  for (const std::vector<HorizonTile>& tiles : {ground.tiles(), tilesOf(meshes)}) {
    const Tally waiting = fly(ground, tiles, 40, {}, 7);
    const Tally all = fly(ground, tiles, 40, {.noWaiting = true}, 7);
    EXPECT_GT(all.hidden, 1000u);
    EXPECT_GT(waiting.hidden, all.hidden * 995 / 1000);
    EXPECT_LE(waiting.hidden, all.hidden);
  }
}

TEST(Horizon, looksAtAFewLinesOnly) {
  const Ground ground(12, 16, 60, 5);
  const std::vector<HorizonTile> tiles = ground.tiles();
  std::size_t waiting = 0, all = 0;
  Horizon horizon;
  for (const double above : {100.0, 400.0, 1500.0}) {
    const Vec3 eye{5000, 5000, ground.heightAt(5000, 5000) + above};
    horizon.build(eye, tiles, {});
    waiting += horizon.work();
    horizon.build(eye, tiles, {.noWaiting = true});
    all += horizon.work();
  }
  EXPECT_LT(waiting, all * 8 / 10);
  std::printf("work: %zu, without waiting %zu\n", waiting, all);
}

TEST(Horizon, doesNoMoreInAStepThanItMay) {
  const Ground ground(12, 16, 60, 5);
  const std::vector<HorizonTile> tiles = ground.tiles();
  const Vec3 eye{5000, 5000, ground.heightAt(5000, 5000) + 400};
  Horizon horizon;
  horizon.begin({eye, eye, 0}, tiles, {});
  EXPECT_EQ(horizon.work(), 0u);
  for (std::size_t before = 0, steps = 0; !horizon.step(20); before = horizon.work(), ++steps) {
    ASSERT_LT(horizon.work() - before, 20u + 24u) << "the last tile's parts and the lines that it asks for";
    ASSERT_LT(steps, 1000u);
  }
}

TEST(Horizon, tellsAllOfItsProfileWhereThatIsAsked) {
  const Ground ground(12, 16, 60, 5);
  const std::vector<HorizonTile> tiles = ground.tiles();
  const Vec3 eye{5000, 5000, ground.heightAt(5000, 5000) + 200};
  Horizon asked, whole, all;
  asked.build(eye, tiles, {});
  whole.build(eye, tiles, {.whole = true});
  all.build(eye, tiles, {.whole = true, .noWaiting = true});
  EXPECT_EQ(asked.hidden(), whole.hidden());
  std::size_t higher = 0;
  for (std::size_t k = 0; k < whole.profile().size(); ++k) {
    EXPECT_LE(asked.profile()[k], whole.profile()[k]);
    EXPECT_EQ(whole.profile()[k], all.profile()[k]);
    higher += asked.profile()[k] < whole.profile()[k];
  }
  EXPECT_GT(higher, 10u);
}

TEST(Horizon, hidesNothingByTilesThatMayNot) {
  const Ground ground(10, 16, 60, 2);
  std::vector<HorizonTile> tiles = ground.tiles();
  for (HorizonTile& tile : tiles) tile.mayOcclude = false;
  Horizon horizon;
  horizon.build({4000, 4000, 200}, tiles, {});
  EXPECT_EQ(horizon.hiddenCount(), 0u);
}

TEST(Horizon, hidesNothingForAnEyeThatIsNowhere) {
  const Ground ground(10, 16, 60, 2);
  const std::vector<HorizonTile> tiles = ground.tiles();
  Horizon horizon;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300})
    for (const Vec3 eye : {Vec3{bad, 4000, 200}, Vec3{4000, 4000, bad}, Vec3{bad, bad, bad}}) {
      horizon.build(eye, tiles, {});
      // An eye far below sees the ground's underside, which hides all the same; the caller refuses it.
      if (eye.z == -1e300 && eye.x == 4000) continue;
      EXPECT_EQ(horizon.hiddenCount(), 0u) << eye.x << ' ' << eye.z;
    }
  horizon.build({4000, 4000, 200}, tiles,
                {.columns = 1024, .slack = std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(horizon.hiddenCount(), 0u);
  horizon.build({4000, 4000, 200}, {}, {});
  EXPECT_TRUE(horizon.hidden().empty());
}

TEST(Horizon, leavesTilesThatItDoesNotKnowOrThatAreNoSurface) {
  const Ground ground(10, 16, 60, 2);
  Horizon horizon;
  const Vec3 eye{4800, 4800, ground.heightAt(4800, 4800) + 10};
  std::vector<HorizonTile> tiles = ground.tiles();
  horizon.build(eye, tiles, {});
  const std::vector<std::uint8_t> before = horizon.hidden();
  std::vector<TileRelief> broken(ground.reliefs());
  std::size_t changed = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (before[t] == 0) continue;
    TileRelief& relief = broken[t];
    switch (changed++ % 4) {
      case 0:
        tiles[t].relief = nullptr;
        continue;
      case 1:
        relief.z[7] = std::numeric_limits<float>::quiet_NaN();
        break;
      case 2:
        relief.x[0] = std::numeric_limits<float>::infinity();
        break;
      default:
        relief.side = 0;
        relief.x.clear();
        relief.y.clear();
        relief.z.clear();
    }
    relief.finish(4);
    tiles[t].relief = &relief;
  }
  ASSERT_GT(changed, 8u);
  horizon.build(eye, tiles, {});
  EXPECT_EQ(horizon.hiddenCount(), 0u) << "all that was hidden is now not known";
}

TEST(Horizon, hidesByMeshesOnlyWhatTheGroundItselfHides) {
  for (const int step : {2, 3, 4}) {
    const Ground ground(10, 16, 60, 20 + static_cast<unsigned>(step));
    const std::vector<MeshRelief> meshes = ground.meshes(step);
    const Tally tally = fly(ground, tilesOf(meshes), 60, {.columns = 1024}, 3);
    const Tally regular = fly(ground, 60, {.columns = 1024}, 3);
    EXPECT_EQ(tally.wrong, 0u) << step;
    EXPECT_GT(tally.hidden, regular.hidden * 8 / 10) << step;
    std::printf("lines every %d posts: %zu of %zu meshes hidden, %zu of the same as tiles\n", step,
                tally.hidden, tally.tiles, regular.hidden);
  }
}

TEST(Horizon, isSeenToFailWhereLinesOfMeshesReachTooHigh) {
  const Ground ground(10, 16, 60, 2);
  const std::vector<MeshRelief> meshes = ground.meshes(4);
  EXPECT_GT(fly(ground, tilesOf(meshes), 60, {.columns = 16, .raised = true}, 3).wrong, 0u);
}

// A tile of one cell has no line inside, so it hides nothing; it can be hidden.
TEST(Horizon, hidesTilesOfTwoTriangles) {
  const Ground ground(10, 16, 60, 2);
  std::vector<HorizonTile> tiles = ground.tiles();
  const Vec3 eye{4800, 4800, ground.heightAt(4800, 4800) + 10};
  Horizon horizon;
  horizon.build(eye, tiles, {});
  std::vector<TileRelief> small;
  for (std::size_t t = 0; t < tiles.size(); ++t)
    if (horizon.hidden()[t] != 0) {
      const TileRelief& r = *tiles[t].relief;
      TileRelief cell;
      cell.side = 2;
      cell.origin = r.origin;
      for (const std::size_t post : {0u, 1u, 17u, 18u}) {
        cell.x.push_back(r.x[post]);
        cell.y.push_back(r.y[post]);
        cell.z.push_back(r.z[post]);
      }
      cell.finish(4);
      EXPECT_EQ(cell.lines, 0);
      small.push_back(cell);
    }
  ASSERT_FALSE(small.empty());
  for (const TileRelief& cell : small) tiles.push_back({&cell, true});
  horizon.build(eye, tiles, {});
  EXPECT_GT(std::count(horizon.hidden().end() - static_cast<std::ptrdiff_t>(small.size()),
                       horizon.hidden().end(), 1),
            static_cast<std::ptrdiff_t>(small.size() / 2));
}

}  // namespace
}  // namespace trimtab
