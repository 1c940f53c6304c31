#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "random_index.h"
#include "trimtab/units/not_finite.h"
#include "view_axes.h"

namespace trimtab {
namespace {

using test::axesOf;

/// Inside the frustum by projecting, as the picture does.
bool isInPicture(Vec3 p, const EyePose& eye, const ViewShape& v) {
  const Vec3 e = eye.axes * (p - eye.position);
  const double depth = -e.z;
  return depth >= v.nearM && e.x >= v.left * depth && e.x <= v.right * depth && e.y >= v.bottom * depth &&
         e.y <= v.top * depth;
}

LevelCut wholeCut(const TerrainIndex& index) {
  LevelCut cut;
  selectLevels(index, {16000, 16000, 500}, {0.1, 1, 1100}, cut);
  return cut;
}

TEST(VisibleSet, neverDropsATileWithAPointInThePicture) {
  const TerrainIndex index = test::randomIndex(32, 11);
  const LevelCut cut = wholeCut(index);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t dropped = 0, seen = 0;
  VisibleSet visible;
  for (int view = 0; view < 300; ++view) {
    ViewShape shape;
    const double wide = 0.2 + unit(random), high = 0.2 + unit(random);
    shape = {1280, 720, -wide, wide * (0.5 + unit(random)), -high, high, 0.5 + 20 * unit(random)};
    const EyePose eye{
        {32000 * unit(random), 32000 * unit(random), 3000 * unit(random)},
        axesOf(360 * unit(random), view % 3 == 0 ? -80 + 10 * unit(random) : 120 * unit(random) - 60,
               360 * unit(random))};
    selectVisible(cut, {.eye = eye, .view = shape}, visible);
    dropped += visible.outsideFrustum;
    const std::vector<CullReason> reason = visible.reasons(index.size());
    for (const TileDraw& tile : cut.tiles) {
      if (reason[tile.node] != CullReason::outside_frustum) continue;
      const Box& b = index.bounds[tile.node];
      for (int i = 0; i < 12; ++i) {
        const auto within = [&](float low, float high_) {
          return low + (high_ - low) * (i < 8 ? double((random() & 1u)) : unit(random));
        };
        const Vec3 p{within(b.minX, b.maxX), within(b.minY, b.maxY), within(b.minZ, b.maxZ)};
        ASSERT_FALSE(isInPicture(p, eye, shape)) << "view " << view << ", node " << tile.node;
        ++seen;
      }
    }
  }
  EXPECT_GT(dropped, 300u * 50) << "nothing was culled, so nothing was tested";
  EXPECT_GT(seen, 100000u);
}

TEST(VisibleSet, drawsTheWholeCutWithoutATest) {
  const TerrainIndex index = test::randomIndex(16, 2);
  const LevelCut cut = wholeCut(index);
  VisibleSet visible;
  selectVisible(cut, {.eye = {{8000, 8000, 5000}, axesOf(0, 80, 0)}, .cull = false}, visible);
  EXPECT_EQ(visible.tiles.size(), cut.tiles.size());
  EXPECT_EQ(visible.outsideFrustum, 0u);
  selectVisible(cut, {.eye = {{8000, 8000, 5000}, axesOf(0, 80, 0)}}, visible);
  EXPECT_TRUE(visible.tiles.empty()) << "the sky has no tiles";
}

TEST(VisibleSet, dropsNothingForAnEyeThatIsNotANumber) {
  const TerrainIndex index = test::randomIndex(16, 2);
  const LevelCut cut = wholeCut(index);
  VisibleSet visible;
  selectVisible(cut, {.eye = {{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {}}}, visible);
  EXPECT_EQ(visible.tiles.size(), cut.tiles.size());
}

TEST(VisibleSet, dropsWhatLiesWhollyBeyondTheVisibilityAndNothingNearer) {
  const TerrainIndex index = test::randomIndex(32, 11);
  const LevelCut cut = wholeCut(index);
  const EyePose eye{{16000, 14000, 900}, axesOf(30, -5, 0)};
  VisibleSet whole, visible;
  selectVisible(cut, {.eye = eye}, whole);
  EXPECT_EQ(whole.beyondVisibility, 0u);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double farM : {0.0, 1.0, 900.0, 4000.0, 9000.0, 15000.0, 1e9}) {
    selectVisible(cut, {.eye = eye, .farM = farM}, visible);
    EXPECT_EQ(visible.outsideFrustum, whole.outsideFrustum) << "the frustum comes first";
    EXPECT_EQ(visible.tiles.size() + visible.beyondVisibility, whole.tiles.size());
    const std::vector<CullReason> reason = visible.reasons(index.size());
    for (const TileDraw& tile : whole.tiles) {
      const Box& b = index.bounds[tile.node];
      // By the definition, from the box's points; the nearest of a fine grid is near enough to see a box
      // kept.
      double nearest = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j) {
          const Vec3 p{b.minX + (double{b.maxX} - b.minX) * i / 20,
                       b.minY + (double{b.maxY} - b.minY) * j / 20,
                       std::clamp(eye.position.z, double{b.minZ}, double{b.maxZ})};
          nearest = std::min(nearest, length(p - eye.position));
        }
      if (reason[tile.node] == CullReason::beyond_visibility)
        ASSERT_GT(nearest, farM) << tile.node;
      else
        ASSERT_LE(nearest,
                  farM + 0.1 * length(Vec3{double{b.maxX} - b.minX, double{b.maxY} - b.minY, 0}) + 1);
    }
  }
}

TEST(VisibleSet, cutsNothingAtAVisibilityThatIsNoNumberOrInfinite) {
  const TerrainIndex index = test::randomIndex(16, 2);
  const LevelCut cut = wholeCut(index);
  VisibleSet visible;
  for (const double farM : {kNan, kInfinity}) {
    selectVisible(cut, {.eye = {{8000, 8000, 5000}, axesOf(0, -40, 0)}, .farM = farM}, visible);
    EXPECT_EQ(visible.beyondVisibility, 0u) << farM;
    EXPECT_GT(visible.tiles.size(), 0u);
  }
  selectVisible(cut, {.eye = {{8000, 8000, 5000}, axesOf(0, -40, 0)}, .farM = 0}, visible);
  EXPECT_TRUE(visible.tiles.empty()) << "nothing is seen at visibility 0";
  selectVisible(cut, {.eye = {{8000, 8000, 5000}, axesOf(0, -40, 0)}, .cull = false, .farM = 0}, visible);
  EXPECT_EQ(visible.tiles.size(), cut.tiles.size()) << "culling case none";
}

TEST(VisibleSet, countsWhatItDrawsAndWhyItDoesNot) {
  const TerrainIndex index = test::randomIndex(32, 7);
  const LevelCut cut = wholeCut(index);
  VisibleSet visible;
  selectVisible(cut, {.eye = {{16000, 14000, 3000}, axesOf(10, -10, 20)}}, visible);
  const std::size_t before = visible.tiles.size();
  ASSERT_GT(before, 20u);
  ASSERT_GT(visible.outsideFrustum, 20u);

  std::vector<std::uint8_t> flags(before);
  for (std::size_t i = 0; i < before; ++i)
    flags[i] = static_cast<std::uint8_t>(i % 4 == 1 ? 1 : i % 4 == 3 ? 2 : 0);
  const VisibleSet all = visible;
  removeOccluded(cut, flags, visible);
  EXPECT_EQ(visible.tiles.size() + visible.occluded + visible.outsideFrustum, cut.tiles.size());
  std::uint64_t triangles = 0, vertices = 0;
  for (std::size_t i = 0, kept = 0; i < before; ++i) {
    const CullReason expected = flags[i] == 1   ? CullReason::occluded
                                : flags[i] == 2 ? CullReason::outside_frustum
                                                : CullReason::drawn;
    EXPECT_EQ(visible.reasonOf(all.tiles[i].node), expected);
    if (flags[i] != 0) continue;
    EXPECT_EQ(visible.tiles[kept++].node, all.tiles[i].node) << "order is kept";
    unsigned sides = 0;
    for (unsigned bits = all.tiles[i].border.bits; bits != 0; bits &= bits - 1) ++sides;
    triangles += 2048 - 16 * sides;
    vertices += 1089 - 16 * sides;
  }
  EXPECT_EQ(visible.triangles, triangles);
  EXPECT_EQ(tileVertices(visible), vertices);
  std::size_t inCut = 0;
  for (const CullReason reason : visible.reasons(index.size())) inCut += reason != CullReason::other_level;
  EXPECT_EQ(inCut, cut.tiles.size());
}

}  // namespace
}  // namespace trimtab
