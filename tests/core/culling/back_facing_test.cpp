#include "trimtab/culling/back_facing.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "random_index.h"

namespace trimtab {
namespace {

constexpr float kInfinityF = std::numeric_limits<float>::infinity();

Vec3 anyDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

/// Unit vectors within `spread` of an axis or so.
std::vector<Vec3> about(Vec3 axis, double spread, std::mt19937& random, int count) {
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) all.push_back(normalized(axis + anyDirection(random) * spread));
  return all;
}

TEST(NormalCone, holdsTheNormalsThatItIsMadeOfAndNotMuchMore) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t known = 0;
  for (int i = 0; i < 20000; ++i) {
    const double spread = i % 3 == 0 ? 1e-4 : unit(random);
    const std::vector<Vec3> normals = about(anyDirection(random), spread, random, 1 + i % 40);
    const NormalCone cone = NormalCone::of(normals);
    if (!cone.isKnown()) continue;
    ++known;
    double largest = 0;
    for (const Vec3& n : normals) {
      ASSERT_GT(dot(n, cone.axis()), 0);
      largest = std::max(largest, length(cross(n, cone.axis())));
    }
    ASSERT_LE(largest, cone.sine());
    ASSERT_LE(cone.sine(), largest + 1.01 / 254);
    const NormalCone same = NormalCone::about(cone.axis(), std::asin(largest));
    ASSERT_GE(same.sine() + 1e-12, largest);
  }
  EXPECT_GT(known, 19000u);
}

TEST(NormalCone, claimsNothingOfNormalsAllAroundOrNone) {
  EXPECT_FALSE(NormalCone::of({}).isKnown());
  EXPECT_FALSE(NormalCone::of(std::array{Vec3{1, 0, 0}, Vec3{-1, 0, 0}}).isKnown());
  EXPECT_FALSE(NormalCone::of(std::array{Vec3{0, 0, 1}, Vec3{kNan, 0, 0}}).isKnown());
  EXPECT_FALSE(NormalCone::about({0, 0, 1}, 1.6).isKnown());
  EXPECT_FALSE(NormalCone::about({0, 0, 1}, kNan).isKnown());
  EXPECT_FALSE(facesAway({}, {0, 0, 0, 1, 1, 1}, {0, 0, -100}));
}

// What is left out shows its back from every place of its box, for every normal of its cone.
TEST(FacesAway, onlyWhereEveryTriangleShowsItsBack) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t away = 0, kept = 0, keptAway = 0, skipped = 0;
  for (int i = 0; i < 60000; ++i) {
    const std::vector<Vec3> normals = about(anyDirection(random), 0.4 * unit(random), random, 12);
    const NormalCone cone = NormalCone::of(normals);
    const double size = std::pow(10, 3 * unit(random));
    const Box box{0,
                  0,
                  0,
                  static_cast<float>(size * unit(random)),
                  static_cast<float>(size * unit(random)),
                  static_cast<float>(size * unit(random))};
    const Vec3 eye = anyDirection(random) * (3000 * unit(random));
    bool all = true;
    for (const Vec3& n : normals)
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{corner & 1 ? box.maxX : 0, corner & 2 ? box.maxY : 0, corner & 4 ? box.maxZ : 0};
        all = all && dot(n, eye - p) < 0;
      }
    const bool left = facesAway(cone, box, eye);
    ASSERT_TRUE(!left || all);
    away += left;
    kept += !left;
    keptAway += !left && all;
    const bool may = mayFaceAway(steepness(cone), box, eye);
    ASSERT_TRUE(may || !left) << "what is skipped must not have been left out";
    skipped += !may;
  }
  EXPECT_GT(away, 10000u);
  EXPECT_GT(kept, 10000u);
  EXPECT_GT(skipped, 2000u);
  EXPECT_LT(keptAway, away / 2) << "of what faces away most is found";
}

TEST(FacesAway, isFalseForWhatIsNotANumberAndForAnEyeInsideTheBox) {
  const NormalCone cone = NormalCone::of(std::array{Vec3{0, 0, 1}});
  const Box box{-10, -10, -1, 10, 10, 1};
  EXPECT_TRUE(facesAway(cone, box, {0, 0, -500}));
  EXPECT_FALSE(facesAway(cone, box, {0, 0, 500}));
  EXPECT_FALSE(facesAway(cone, box, {0, 0, 0}));
  EXPECT_FALSE(facesAway(cone, box, {0, 0, -0.5}));
  EXPECT_FALSE(facesAway(cone, box, {kNan, 0, -500}));
  const auto nan = static_cast<float>(kNan);
  for (const Box& bad : {Box{nan, 0, 0, 1, 1, 1}, Box{0, 0, 0, 1, 1, nan}, Box{0, 0, 0, kInfinityF, 1, 1},
                         Box{-kInfinityF, -kInfinityF, -kInfinityF, kInfinityF, kInfinityF, kInfinityF}})
    EXPECT_FALSE(facesAway(cone, bad, {0, 0, -500}));
}

/// The sum of what a view draws and leaves out by reason is the cut, and back faces are tested last.
TEST(BackFaces, areLeftOutOfACutWhereAskedForOnly) {
  TerrainIndex index = test::randomIndex(32, 9);
  std::mt19937 random(4);
  for (std::size_t i = 0; i < index.size(); ++i)
    index.cones.push_back(NormalCone::of(about(normalized({0.9, 0, 0.5}), 0.3, random, 10)));
  LevelCut cut;
  selectLevels(index, {16000, 16000, 500}, {0.1, 1, 1100}, cut);
  VisibleSet both, fronts;
  std::size_t away = 0;
  for (int view = 0; view < 200; ++view) {
    const Vec3 forward = anyDirection(random), right = normalized(cross(forward, anyDirection(random)));
    const EyePose eye{{32000.0 * view / 200, 16000, 500.0 + 20 * view},
                      {{right, cross(right, forward), -forward}}};
    selectVisible(cut, {.eye = eye}, both);
    selectVisible(cut, {.eye = eye, .backFaces = true}, fronts);
    EXPECT_EQ(both.backFacing, 0u);
    ASSERT_EQ(both.tiles.size(), fronts.tiles.size() + fronts.backFacing);
    away += fronts.backFacing;
    for (std::size_t i = 0; i < cut.tiles.size(); ++i) {
      const bool back = facesAway(index.cones[cut.tiles[i].node], cut.boxes[i], eye.position);
      ASSERT_EQ(fronts.reason[i],
                both.reason[i] == CullReason::drawn && back ? CullReason::back_facing : both.reason[i]);
    }
    std::uint64_t triangles = 0;
    for (const TileDraw& tile : fronts.tiles)
      triangles += 2048 - 16u * static_cast<unsigned>(std::popcount(tile.border.bits));
    ASSERT_EQ(fronts.triangles, triangles);
  }
  EXPECT_GT(away, 1000u);
  selectVisible(cut, {.cull = false, .farM = 1e9, .backFaces = true}, fronts);
  EXPECT_EQ(fronts.tiles.size(), cut.tiles.size()) << "culling case none";
}

}  // namespace
}  // namespace trimtab
