#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "random_index.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/units/not_finite.h"

/// Views and boxes that no one should send: nothing may be left out wrongly.
namespace trimtab {
namespace {

constexpr float kInfinityF = std::numeric_limits<float>::infinity(),
                kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr Mat3 kNorth{{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}}};
constexpr Mat3 kSouth{{Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 1, 0}}};
constexpr Mat3 kDown{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
constexpr Mat3 kUp{{Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1}}};

LevelCut cutOf(const TerrainIndex& index) {
  LevelCut cut;
  selectLevels(index, {16000, 16000, 500}, {1e-6, 1, 1100}, cut);
  return cut;
}

/// The set is exactly what the double-precision test keeps, box by box.
void expectExact(const LevelCut& cut, const TerrainIndex& index, const EyePose& eye, const ViewShape& view) {
  VisibleSet visible;
  selectVisible(cut, {.eye = eye, .view = view, .backFaces = true}, visible);
  const Frustum frustum(eye, view);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < cut.tiles.size(); ++i) {
    const bool may = frustum.mayShow(index.bounds[cut.tiles[i].node]);
    ASSERT_EQ(visible.reason[i] == CullReason::drawn, may) << i;
    shown += may;
  }
  EXPECT_EQ(visible.tiles.size(), shown);
  EXPECT_EQ(visible.outsideFrustum, cut.tiles.size() - shown);
}

TEST(DegenerateSelection, boxesThatAreInfiniteOrNoNumbersAreNeverLeftOut) {
  for (const Box& bad :
       {Box{kNoNumber, 0, 0, 1, 1, 1}, Box{0, 0, 0, 1, 1, kNoNumber}, Box{0, 0, 0, kInfinityF, 1, 1},
        Box{0, -kInfinityF, 0, 1, kInfinityF, 1}, Box{-kInfinityF, -kInfinityF, -kInfinityF, 0, 0, 0},
        Box{kNoNumber, kNoNumber, kNoNumber, kNoNumber, kNoNumber, kNoNumber}}) {
    TerrainIndex index = test::randomIndex(32, 5);
    LevelCut cut = cutOf(index);
    const std::array places{std::size_t{0}, std::size_t{63}, std::size_t{64}, cut.tiles.size() - 1};
    for (const std::size_t place : places) index.bounds[cut.tiles[place].node] = bad;
    gather(index, cut);
    // Looking away from all of it, but for those whose sides are numbers: they are judged by them.
    const EyePose eye{{16000, -5000, 900}, kSouth};
    expectExact(cut, index, eye, {});
    expectExact(cut, index, {{16000, 12000, 900}, kNorth}, {});
    VisibleSet visible;
    selectVisible(cut, {.eye = {{16000, 12000, 900}, kNorth}, .farM = 4000}, visible);
    if (std::isnan(bad.minX) && std::isnan(bad.maxZ)) {
      for (const std::size_t place : places) EXPECT_EQ(visible.reason[place], CullReason::drawn);
    }
    EXPECT_EQ(visible.tiles.size() + visible.outsideFrustum + visible.beyondVisibility, cut.tiles.size());
  }
}

TEST(DegenerateSelection, viewsWithoutWidthOrAttitudeKeepWhatTheyMayShow) {
  const TerrainIndex index = test::randomIndex(32, 6);
  const LevelCut cut = cutOf(index);
  const EyePose eye{{16000, 12000, 900}, kNorth};
  ViewShape slit;
  slit.left = slit.right = 0;
  ViewShape point = slit;
  point.bottom = point.top = 0;
  ViewShape none;
  none.left = kNan;
  ViewShape half;
  half.right = std::numeric_limits<double>::infinity();
  ViewShape noNear;
  noNear.nearM = kNan;
  for (const ViewShape& view : {slit, point, none, half, noNear}) expectExact(cut, index, eye, view);
  VisibleSet visible;
  selectVisible(cut, {.eye = eye, .view = point}, visible);
  EXPECT_GT(visible.tiles.size(), 0u) << "what the line of sight goes through";
  for (std::size_t bad = 0; bad < 3; ++bad) {
    EyePose lost = eye;
    lost.axes.row[bad] = {kNan, kNan, kNan};
    expectExact(cut, index, lost, {});
  }
  const Vec3 no{kNan, kNan, kNan};
  selectVisible(cut, {.eye = {{16000, 12000, 900}, Mat3{{no, no, no}}}, .farM = kNan, .backFaces = true},
                visible);
  EXPECT_EQ(visible.tiles.size(), cut.tiles.size());
  const double far = std::numeric_limits<double>::infinity();
  expectExact(cut, index, {{far, 0, 0}, kNorth}, {});
}

TEST(DegenerateSelection, anEyeInABoxOrStraightUpOrDownSeesIt) {
  const TerrainIndex index = test::randomIndex(32, 7);
  const LevelCut cut = cutOf(index);
  VisibleSet visible;
  for (std::size_t i = 0; i < cut.tiles.size(); i += 37) {
    const Box& b = cut.boxes[i];
    const Vec3 inside{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                      0.5 * (double{b.minZ} + b.maxZ)};
    for (const Mat3& axes : {kNorth, kDown, kUp}) {
      expectExact(cut, index, {inside, axes}, {});
      selectVisible(cut, {.eye = {inside, axes}, .farM = 0.0}, visible);
      EXPECT_EQ(visible.reason[i], CullReason::drawn);
    }
  }
}

TEST(DegenerateSelection, emptyCutsAndCutsOfOneTileAreSelected) {
  VisibleSet visible;
  LevelCut cut;
  selectVisible(cut, {}, visible);
  EXPECT_TRUE(visible.tiles.empty());
  EXPECT_EQ(visible.reasonOf(0), CullReason::other_level);
  gather(TerrainIndex{}, cut);
  selectVisible(cut, {.farM = 100, .backFaces = true}, visible);
  EXPECT_TRUE(visible.tiles.empty());
  EXPECT_EQ(visible.reasons(2), std::vector<CullReason>(2, CullReason::other_level));
  for (const std::uint32_t n : {1u, 2u, 8u}) {
    const TerrainIndex index = test::randomIndex(n, 8);
    const LevelCut some = cutOf(index);
    expectExact(some, index, {{500, -2000, 600}, kNorth}, {});
    selectVisible(some, {.eye = {{500, -2000, 600}, kNorth}}, visible);
    EXPECT_FALSE(visible.tiles.empty());
  }
}

/// Earlier sets keep telling of their own cut when the cut goes on.
TEST(VisibleSet, tellsReasonsOfItsOwnCutWhenTheCutGoesOn) {
  const TerrainIndex index = test::randomIndex(16, 2);
  LevelCut cut = cutOf(index);
  VisibleSet visible;
  selectVisible(cut, {.eye = {{8000, 2000, 900}, kNorth}}, visible);
  const std::vector<CullReason> before = visible.reasons(index.size());
  const VisibleSet kept = visible;
  selectLevels(index, {1e6, 1e6, 5e5}, {100, 1, 1100}, cut);
  selectVisible(cut, {.eye = {{8000, 2000, 900}, kNorth}}, visible);
  EXPECT_EQ(kept.reasons(index.size()), before);
  EXPECT_NE(visible.reasons(index.size()), before);
}

}  // namespace
}  // namespace trimtab
