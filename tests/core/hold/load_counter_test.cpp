#include "trimtab/hold/load_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "tests/core/culling/random_index.h"
#include "tests/core/culling/random_patches.h"
#include "tests/core/culling/random_trees.h"
#include "tests/core/culling/view_axes.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/select_patches.h"
#include "trimtab/hold/arbiter.h"

namespace trimtab {
namespace {

LoadView viewAt(Vec3 eye, double heading, double pitch,
                double farM = std::numeric_limits<double>::infinity()) {
  return {{eye, test::axesOf(heading, pitch)}, {}, farM};
}

/// Returns the triangles of a cut that the renderer's selector draws.
double drawn(const LevelCut& cut, const LoadView& view) {
  VisibleSet visible;
  selectVisible(cut, {.eye = view.eye, .view = view.view, .farM = view.farM}, visible);
  return static_cast<double>(visible.triangles);
}

/// Not on the scale, so that the first step to it is a part of a place.
constexpr double kAskedPx = 1.3;

/// The allowed error of a step: what is asked for, then the places of the scale above it, written once more.
double errorOf(std::size_t k) {
  if (k == 0) return kAskedPx;
  const double place = std::pow(2, 1.0 / 16);
  double px = 0.125;
  while (px <= kAskedPx) px *= place;
  return px * std::pow(place, static_cast<double>(k - 1));
}

/// Every so many steps are compared with what a selector draws, which takes time.
constexpr std::size_t kChecked = 5;

/// Views from inside, above and beyond a square of so many metres.
template <class Check>
void forManyViews(double sizeM, const Check& check) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 60; ++i)
    check(viewAt({between(-0.2, 1.2) * sizeM, between(-0.2, 1.2) * sizeM, between(200, 4000)},
                 between(0, 360), between(-60, 30),
                 i % 3 == 0 ? between(0.1, 1) * sizeM : std::numeric_limits<double>::infinity()));
}

TEST(LoadCounter, countsWhatTheTreesDraw) {
  const StaticLodIndex index = test::randomTrees(4, 11);
  const std::vector<float> error = staticLodError(index, ErrorMeasure::rms);
  std::vector<std::uint64_t> stack;
  double all = 0;
  forManyViews(32000, [&](const LoadView& view) {
    for (const double spread : {1.0, 0.8}) {
      const StaticLodRule rule{900, spread, 5000};
      const TriangleLadder ladder = countTriangles(index, error, view, rule, kAskedPx, stack);
      for (std::size_t k = 0; k < kErrorSteps; k += kChecked) {
        LevelCut cut;
        // A rule of the k-th step accepts an error that much larger at the same distance.
        selectStatic(index, error, {rule.distancePerError * kAskedPx / errorOf(k), spread, 5000},
                     view.eye.position, cut);
        EXPECT_NEAR(ladder[k], drawn(cut, view), 0.5) << k;
        all += ladder[k];
      }
    }
  });
  EXPECT_GT(all, 1e6);
}

TEST(LoadCounter, countsTilesButForWhatNeighboursAdd) {
  const TerrainIndex index = test::randomIndex(32, 5);
  std::vector<std::uint64_t> stack;
  double counted = 0, all = 0;
  forManyViews(32000, [&](const LoadView& view) {
    const CutRule rule{kAskedPx, 1, 1100};
    const TriangleLadder ladder = countTriangles(index, view, rule, kAskedPx, stack);
    for (std::size_t k = 0; k < kErrorSteps; k += kChecked) {
      LevelCut cut;
      selectLevels(index, view.eye.position, {errorOf(k), 1, 1100}, cut);
      counted += ladder[k], all += drawn(cut, view);
    }
  });
  EXPECT_GT(all, 1e6);
  EXPECT_NEAR(counted / all, 0.9, 0.15);
}

TEST(LoadCounter, countsPatchesButForWhatNeighboursAdd) {
  const PatchIndex index = test::RandomPatches::make(513, 513, 128, 8, 3, 9);
  std::vector<std::uint64_t> stack;
  double counted = 0, all = 0;
  forManyViews(5120, [&](const LoadView& view) {
    const CutRule rule{kAskedPx, 1, 1100};
    const TriangleLadder ladder = countTriangles(index, view, rule, kAskedPx, stack);
    for (std::size_t k = 0; k < kErrorSteps; k += kChecked) {
      PatchCut cut;
      selectPatches(index, {}, view.eye.position, {errorOf(k), 1, 1100}, cut);
      counted += ladder[k], all += drawn(cut.cut, view);
    }
  });
  EXPECT_GT(all, 1e5);
  EXPECT_NEAR(counted / all, 1, 0.2);
}

TEST(LoadCounter, namesTheNodesThatTheTreesDraw) {
  const StaticLodIndex index = test::randomTrees(4, 11);
  const std::vector<float> error = staticLodError(index, ErrorMeasure::rms);
  std::vector<std::uint64_t> stack;
  std::size_t named = 0;
  forManyViews(32000, [&](const LoadView& view) {
    LevelCut cut;
    selectStatic(index, error, {900, 1, 5000}, view.eye.position, cut);
    VisibleSet visible;
    selectVisible(cut, {.eye = view.eye, .view = view.view, .farM = view.farM}, visible);
    std::vector<std::uint32_t> drawn, nodes;
    for (const TileDraw& node : visible.tiles) drawn.push_back(node.node);
    collectNodes(index, error, view, {900, 1, 5000}, stack, nodes);
    std::sort(drawn.begin(), drawn.end());
    std::sort(nodes.begin(), nodes.end());
    EXPECT_EQ(nodes, drawn);
    named += nodes.size();
  });
  EXPECT_GT(named, 1000u);
}

TEST(LoadCounter, namesTheTilesThatItCounts) {
  const TerrainIndex index = test::randomIndex(32, 5);
  std::vector<std::uint64_t> stack;
  std::size_t alike = 0, all = 0;
  forManyViews(32000, [&](const LoadView& view) {
    const CutRule rule{2, 1, 1100};
    std::vector<std::uint32_t> nodes;
    collectNodes(index, view, rule, stack, nodes);
    EXPECT_EQ(2048.0 * static_cast<double>(nodes.size()),
              countTriangles(index, view, rule, 2, stack).front());
    LevelCut cut;
    selectLevels(index, view.eye.position, rule, cut);
    std::vector<std::uint8_t> inCut(index.size());
    for (const TileDraw& tile : cut.tiles) inCut[tile.node] = 1;
    // Neighbours split some of them further.
    for (const std::uint32_t node : nodes) alike += inCut[node];
    all += nodes.size();
  });
  EXPECT_GT(all, 100u);
  EXPECT_GT(static_cast<double>(alike), 0.8 * static_cast<double>(all));
}

/// Two models in a row of cells below one root, as the reader of a database makes them.
std::shared_ptr<const ObjectIndex> rowOfCells(std::size_t cells) {
  auto index = std::make_shared<ObjectIndex>();
  index->levels = {{0, 600, 0}, {0.05F, 240, 0}, {0.4F, 60, 0}, {2.5F, 4, 0}, {0, 90, 0}, {0.2F, 12, 0}};
  index->models = {{0, 4, 3}, {4, 2, 2}};
  const auto count = static_cast<std::uint32_t>(cells);
  for (std::uint32_t i = 0; i <= count; ++i) {
    ObjectIndex::Cell cell;
    const float x = 900.0F * static_cast<float>(i), end = 900.0F * static_cast<float>(count) + 20;
    cell.bounds = i == 0 ? Box{-10, -10, 0, end, 20, 10} : Box{x, -10, 0, x + 20, 10, 10};
    cell.firstInstance = i == 0 ? 0 : 3 * (i - 1);
    cell.instances = i == 0 ? 3 * count : 3;
    cell.end = i == 0 ? count + 1 : i + 1;
    cell.largestRadiusM = 4.5F;
    index->cells.push_back(cell);
    if (i == 0) continue;
    for (const auto& [model, scale] : {std::pair{0U, 1.0F}, {0U, 1.5F}, {1U, 0.7F}})
      index->instances.push_back({0, 0, 0, {0, 0, 0, 32767}, scale, model});
  }
  return index;
}

TEST(LoadCounter, objectsAreCountedByHalfOctavesOfWhatACellAccepts) {
  const std::shared_ptr<const ObjectIndex> index = rowOfCells(12);
  const ObjectLoad load(index);
  // Looks along the row from before it, far enough to the side that some cells are outside the view.
  const LoadView view = viewAt({-400, 60, 30}, 90, 0);
  const CutRule rule{kAskedPx, 1.25, 11000};
  FrameLevers levers;
  levers.objectFarM = 9000;
  const TriangleLadder ladder = countTriangles(load, view, rule, kAskedPx, levers);
  const Frustum frustum(view.eye, view.view);
  double most = 0;
  for (std::size_t k = 0; k < kErrorSteps; ++k) {
    double expected = 0;
    for (std::uint32_t c = 1; c < index->cells.size(); ++c) {
      const ObjectIndex::Cell& cell = index->cells[c];
      const double away = std::sqrt(distanceSquared(cell.bounds, view.eye.position));
      if (away > levers.objectFarM || !frustum.mayShow(cell.bounds)) continue;
      // What is accepted, down to the half octave below it.
      const double accepted = away * errorOf(k) * 1.25 / 11000;
      double half = 0.01;
      while (half * std::sqrt(2.0) <= accepted * (1 + 1e-9)) half *= std::sqrt(2.0);
      for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
        const ObjectInstance& instance = index->instances[i];
        const ObjectIndex::Model& model = index->models[instance.model];
        std::uint32_t level = model.firstLevel;
        for (std::uint32_t l = model.firstLevel; l < model.firstLevel + model.levels; ++l)
          if (index->levels[l].errorM * instance.scale <= half * (1 + 1e-6)) level = l;
        expected += index->levels[level].triangles;
      }
    }
    EXPECT_EQ(ladder[k], expected) << k;
    most = std::max(most, expected);
  }
  EXPECT_GT(most, 1000);
  EXPECT_LT(ladder.back(), most / 4) << "an octave coarser must be fewer";
}

TEST(LoadCounter, fallsAlongTheLadderAndOutsideTheView) {
  const StaticLodIndex index = test::randomTrees(4, 12);
  const std::vector<float> error = staticLodError(index, ErrorMeasure::maximum);
  std::vector<std::uint64_t> stack;
  const LoadView view = viewAt({16000, 16000, 1500}, 30, -10);
  const TriangleLadder ladder = countTriangles(index, error, view, {900}, kAskedPx, stack);
  // A node half in view may have more triangles than those of its children that are in view.
  for (std::size_t k = 1; k < kErrorSteps; ++k) EXPECT_LE(ladder[k], 1.03 * ladder[k - 1]);
  for (std::size_t k = kPlacesPerOctave; k < kErrorSteps; ++k)
    EXPECT_LT(ladder[k], ladder[k - kPlacesPerOctave]);
  const TriangleLadder sky =
      countTriangles(index, error, viewAt({16000, 16000, 5000}, 30, 80), {900}, kAskedPx, stack);
  EXPECT_EQ(sky, TriangleLadder{});
}

TEST(LoadCounter, anEyeThatIsNoNumberIsDefined) {
  const TerrainIndex index = test::randomIndex(8, 5);
  std::vector<std::uint64_t> stack;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double triangles : countTriangles(index, viewAt({nan, 0, 0}, 0, 0), {2, 1, 1100}, 2, stack))
    EXPECT_TRUE(std::isfinite(triangles));
}

TEST(ShareBelowHorizon, isHalfWhenLevelAndAllWhenLookingDown) {
  const Vec3 up{0, 0, 1};
  EXPECT_NEAR(shareBelowHorizon(viewAt({0, 0, 0}, 10, 0), up, 0), 0.5, 0.07);
  EXPECT_EQ(shareBelowHorizon(viewAt({0, 0, 0}, 10, -60), up, 100), 1);
  EXPECT_EQ(shareBelowHorizon(viewAt({0, 0, 0}, 10, 60), up, 100), 0);
  // From 12 km the horizon is 3.5 degrees down.
  EXPECT_LT(shareBelowHorizon(viewAt({0, 0, 0}, 10, 0), up, 12000), 0.47);
}

TEST(TrianglesAt, liesOnTheLadderAndBetweenItsSteps) {
  TriangleLadder ladder{};
  for (std::size_t k = 0; k < kErrorSteps; ++k) ladder[k] = 9000 - 100 * static_cast<double>(k);
  EXPECT_DOUBLE_EQ(trianglesAt(ladder, 2, 2), 9000);
  EXPECT_NEAR(trianglesAt(ladder, 2, 4), 7400, 1e-9);
  EXPECT_NEAR(trianglesAt(ladder, 2, 2 * std::exp2(0.3125 / 8)), 8937.5, 1e-9);
  EXPECT_NEAR(trianglesAt(ladder, 2, 640), 9000 - 100.0 * (kErrorSteps - 1), 1e-9);
  EXPECT_DOUBLE_EQ(trianglesAt(ladder, 2, 1), 9000);
  // From an error between two places the first step is shorter than a place.
  for (std::size_t k = 0; k < kErrorSteps; ++k)
    EXPECT_NEAR(trianglesAt(ladder, kAskedPx, errorOf(k)), ladder[k], 1e-6) << k;
  EXPECT_NEAR(trianglesAt(ladder, kAskedPx, std::sqrt(kAskedPx * errorOf(1))), 8950, 1e-6);
}

TEST(TrianglesAt, placesToNextLieAboveNoneAndAtMostOne) {
  EXPECT_DOUBLE_EQ(placesToNext(1), 1);
  EXPECT_NEAR(placesToNext(kAskedPx), 16 * std::log2(errorOf(1) / kAskedPx), 1e-9);
  EXPECT_NEAR(placesToNext(0.125 * std::exp2(7.0 / 32)), 0.5, 1e-9);
  for (const double px : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(placesToNext(px), 1) << px;
}

}  // namespace
}  // namespace trimtab
