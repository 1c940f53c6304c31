#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "trimtab/culling/horizon.h"

/// Where one quarter of the horizon, or one block of a tile's posts, goes over into the next.
namespace trimtab {
namespace {

/// A ridge across the way along +x up to `endM`, where it falls off; a place far behind it.
struct Ridge {
  double atM, endM, topM;

  double heightAt(double x, double y) const {
    return topM * std::max(0.0, 1 - std::abs(x - atM) / 100) * std::clamp(1 - (y - endM) / 100, 0.0, 1.0);
  }
  TileRelief tile(double x0, double y0, double wide, double high) const {
    TileRelief r;
    r.side = 9;
    r.origin = {x0, y0, 0};
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i) {
        r.x.push_back(static_cast<float>(wide * i / 8));
        r.y.push_back(static_cast<float>(high * j / 8));
        r.z.push_back(static_cast<float>(heightAt(x0 + wide * i / 8, y0 + high * j / 8)));
      }
    r.finish(4);
    return r;
  }
  /// Whether p, which is flat ground, is hidden for the region.
  bool hides(const ValidityRegion& region, Vec3 p) const {
    const TileRelief ridge = tile(atM - 100, endM - 3200, 200, 3200), end = tile(atM - 100, endM, 200, 100),
                     far = tile(p.x - 50, p.y - 50, 100, 100);
    Horizon horizon;
    horizon.buildFor(region,
                     std::vector<HorizonTile>{{.relief = &ridge, .mayOcclude = true, .north = &end},
                                              {.relief = &end, .mayOcclude = true},
                                              {.relief = &far}},
                     {});
    return horizon.hidden()[2] != 0;
  }
  bool isCovered(Vec3 eye, Vec3 p) const {
    for (double s = 0; s < 0.99; s += 1e-5)
      if (heightAt(eye.x + s * (p.x - eye.x), eye.y + s * (p.y - eye.y)) > eye.z + s * (p.z - eye.z))
        return true;
    return false;
  }
};

/// An eye that goes sideways looks past the end of what hides a place from the region's middle, and that end
/// lies where two quarters meet.
TEST(HorizonRoom, holdsWhereTwoQuartersMeet) {
  const Ridge ridge{.atM = 8500, .endM = 8517, .topM = 2000};
  std::size_t seen = 0;
  for (const double half : {0.0, 50.0, 165.0, 330.0, 900.0})
    for (double t = 0.9; t < 1.005; t += 0.0025) {
      const ValidityRegion region{{0, -half, 200}, {0, half, 200}, 2.5};
      const Vec3 p{400'000, 400'000 * t, 0};
      if (ridge.isCovered(region.from, p) && ridge.isCovered(region.to, p)) continue;
      ++seen;
      EXPECT_FALSE(ridge.hides(region, p)) << half << " m, " << t;
    }
  EXPECT_GT(seen, 30u);
  EXPECT_TRUE(ridge.hides({{0, -50, 200}, {0, 50, 200}, 2.5}, {400'000, 380'000, 0}));
}

TEST(HorizonRoom, holdsStraightUpAlsoWithoutARadius) {
  const Ridge ridge{.atM = 3000, .endM = 1600, .topM = 500};
  for (const double radius : {0.0, 0.5}) {
    const Vec3 p{20'000, 0, 0};
    ASSERT_FALSE(ridge.isCovered({0, 0, 650}, p));
    EXPECT_FALSE(ridge.hides({{0, 0, 50}, {0, 0, 650}, radius}, p));
    EXPECT_TRUE(ridge.hides({{0, 0, 50}, {0, 0, 350}, radius}, p));
  }
}

/// A tile of flat ground with one post raised, seen through a gap in a wall that is 2 cells narrow at most
/// and beside the post: the raised post alone looks over the low wall behind the gap.
class GapScene {
 public:
  static constexpr float kEyeM = 50, kLowM = 100, kWallM = 2000, kThickM = 20, kTileM = 6000, kSizeM = 900;

  GapScene(int posts, int side) : posts_(posts), side_(side), low_(wall(kWallM, -0.4f, 0.4f, kLowM)) {}

  /// Whether the tile is hidden: `post`, raised or not, counted through the gap at `beside` cells from it.
  bool isHidden(int post, float beside, bool raised, SimdLevel simd) const {
    const int i = post % posts_, j = post / posts_;
    const float f = kTileM + cell() * static_cast<float>(away(i, j)),
                l = cell() * (static_cast<float>(across(i, j)) + beside) - 0.5f * kSizeM,
                gap = 0.15f * cell() / f;
    const TileRelief before = wall(kWallM - 200, -0.4f, l / f - gap, 400),
                     after = wall(kWallM - 200, l / f + gap, 0.4f, 400);
    const TileRelief tile = relief(posts_, kTileM, kSizeM, -0.5f * kSizeM, 0.5f * kSizeM, [&](int c, int r) {
      const float forwards = kTileM + cell() * static_cast<float>(away(c, r)),
                  sideways = cell() * static_cast<float>(across(c, r)) - 0.5f * kSizeM;
      if (std::abs(sideways - l / f * forwards) >= 3 * cell()) return 800.0f;  // behind the high walls
      // In the gap, over the low one or, as all of a block reaches, below it.
      return raised && c == i && r == j
                 ? kLowM + 2 + (kLowM - kEyeM) / kWallM * (forwards - kWallM)
                 : kEyeM - 6 + (kLowM - kEyeM) / (kWallM + kThickM) * (forwards - 2 * cell());
    });
    const std::vector<HorizonTile> tiles{{.relief = &low_, .mayOcclude = true},
                                         {.relief = &before, .mayOcclude = true},
                                         {.relief = &after, .mayOcclude = true},
                                         {.relief = &tile}};
    Horizon horizon;
    horizon.build({0, 0, kEyeM}, tiles, {.columns = 8192, .simd = simd});
    return horizon.hidden()[3] != 0;
  }
  /// Cells that a post is from the tile's border on the right.
  int across(int i, int j) const {
    const std::array<int, 4> cells{j, posts_ - 1 - i, posts_ - 1 - j, i};
    return cells[static_cast<std::size_t>(side_)];
  }

 private:
  float cell() const { return kSizeM / static_cast<float>(posts_ - 1); }
  int away(int i, int j) const {
    const std::array<int, 4> cells{i, j, posts_ - 1 - i, posts_ - 1 - j};
    return cells[static_cast<std::size_t>(side_)];
  }
  std::array<float, 2> plan(float f, float l) const {
    constexpr std::array<std::array<float, 2>, 4> kForward{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto [a, b] = kForward[static_cast<std::size_t>(side_)];
    return {a * f - b * l, b * f + a * l};
  }
  template <class Height>
  TileRelief relief(int posts, float f, float size, float l0, float l1, const Height& height) const {
    const auto [xa, ya] = plan(f, l0);
    const auto [xb, yb] = plan(f + size, l1);
    TileRelief r;
    r.side = posts;
    const float cells = static_cast<float>(posts - 1);
    for (int j = 0; j < posts; ++j)
      for (int i = 0; i < posts; ++i) {
        r.x.push_back(std::min(xa, xb) + std::abs(xb - xa) * static_cast<float>(i) / cells);
        r.y.push_back(std::min(ya, yb) + std::abs(yb - ya) * static_cast<float>(j) / cells);
        r.z.push_back(height(i, j));
      }
    r.finish(4);
    return r;
  }
  TileRelief wall(float f, float t0, float t1, float z) const {
    return relief(9, f, kThickM, f * t0, f * t1, [z](int, int) { return z; });
  }

  int posts_, side_;
  TileRelief low_;
};

/// The raised post is hardly higher than what stays hidden, and lower than most of its part: so each post
/// counts in each block that holds it, the lowest and those of the last rows and columns too.
TEST(Horizon, seesATileByAnyBlockOfAnyOfItsPosts) {
  for (const int posts : {9, 12, 33})
    for (int side = 0; side < Horizon::kSides; ++side) {
      const GapScene scene(posts, side);
      for (int post = 0; post < posts * posts; ++post)
        for (const float beside : {-0.4f, 0.4f}) {
          if (scene.across(post % posts, post / posts) == (beside < 0 ? 0 : posts - 1)) continue;
          for (const SimdLevel simd : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
            if (posts > 12 && simd != SimdLevel::avx512) continue;
            for (const bool raised : {false, true})
              ASSERT_EQ(scene.isHidden(post, beside, raised, simd), !raised)
                  << posts << " posts, quarter " << side << ", post " << post % posts << ", " << post / posts;
          }
        }
    }
}

}  // namespace
}  // namespace trimtab
