#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "lod_ground.h"
#include "trimtab/culling/moving_horizon.h"
#include "trimtab/units/geodesy.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using test::LodGround;

LodGround& ground() {
  static LodGround ground(16, 30, 11);
  return ground;
}

LevelCut cutAt(Vec3 eye) {
  LevelCut cut;
  selectLevels(ground().index(), eye, {0.004, 1, 1}, cut);
  ground().draw(cut);
  return cut;
}

Vec3 middle(double aboveM) {
  const double m = 0.5 * ground().sideM();
  return {m, m, ground().sourceAt(m, m) + aboveM};
}

TEST(HorizonRoom, holdsForEveryEyeInIt) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  Horizon horizon;
  std::size_t asked = 0, wrong = 0, hidden = 0, exact = 0;
  for (int place = 0; place < 40; ++place) {
    const auto off = [&](double m) { return m * (2 * unit(random) - 1); };
    const double m = ground().sideM();
    Vec3 from{m * (0.2 + 0.6 * unit(random)), m * (0.2 + 0.6 * unit(random)), 0};
    from.z = ground().sourceAt(from.x, from.y) + 40 + 200 * unit(random);
    const ValidityRegion region{from, from + Vec3{off(60), off(60), off(20)}, 8 * unit(random)};
    const LevelCut cut = cutAt(from);
    const std::vector<HorizonTile> tiles = ground().tiles(cut);
    horizon.build(from, tiles, {.columns = 512});
    exact += horizon.hiddenCount();
    horizon.buildFor(region, tiles, {.columns = 512});
    hidden += horizon.hiddenCount();
    std::vector<std::size_t> claimed;
    for (std::size_t t = 0; t < tiles.size(); ++t)
      if (horizon.hidden()[t] != 0) claimed.push_back(t);
    for (int k = 0; k < 600 && !claimed.empty(); ++k) {
      const double s = unit(random);
      Vec3 beside{off(1), off(1), off(1)};
      if (k % 2 == 0) beside = beside * (1 / std::max(length(beside), 1e-9));  // on the very edge
      if (length(beside) > 1) continue;
      const Vec3 eye = region.from + s * (region.to - region.from) + (region.radius * 0.9999) * beside;
      ASSERT_TRUE(region.holds(eye));
      if (eye.z < ground().heightAt(eye.x, eye.y) + 1) continue;
      const std::size_t t = claimed[static_cast<std::size_t>(unit(random) * double(claimed.size()))];
      const Vec3 p = ground().pointOf(cut.tiles[t].node, std::round(16 * unit(random)) / 16,
                                      std::round(16 * unit(random)) / 16);
      ++asked;
      wrong += !ground().isCovered(eye, p);
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(asked, 5000u);
  EXPECT_GT(hidden, exact / 3);
  std::printf("%zu hidden for regions, %zu for their beginnings, %zu points asked\n", hidden, exact, asked);
}

TEST(HorizonRoom, isTheSameBitByBitAndOnAnyProcessor) {
  const Vec3 eye = middle(60);
  const LevelCut cut = cutAt(eye);
  const std::vector<HorizonTile> tiles = ground().tiles(cut);
  for (const ValidityRegion& region :
       {ValidityRegion{eye, eye, 0}, ValidityRegion{eye, eye + Vec3{40, 20, 3}, 2}}) {
    Horizon whole;
    whole.buildFor(region, tiles, {.columns = 700, .simd = SimdLevel::portable});
    EXPECT_GT(whole.hiddenCount(), 20u);
    for (const SimdLevel simd : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
      Horizon pieces;
      pieces.begin(region, tiles, {.columns = 700, .simd = simd});
      std::size_t steps = 0;
      for (; !pieces.step(7); ++steps)
        for (std::size_t t = 0; t < tiles.size(); ++t)
          ASSERT_LE(pieces.hidden()[t], whole.hidden()[t]) << "it never says more than in the end";
      EXPECT_GT(steps, 20u);
      EXPECT_EQ(pieces.hidden(), whole.hidden());
      EXPECT_TRUE(std::equal(pieces.profile().begin(), pieces.profile().end(), whole.profile().begin(),
                             whole.profile().end()));
    }
  }
}

TEST(HorizonRoom, ofNoPlacesHidesNothing) {
  const Vec3 eye = middle(60);
  const LevelCut cut = cutAt(eye);
  const std::vector<HorizonTile> tiles = ground().tiles(cut);
  Horizon horizon;
  for (const ValidityRegion& region :
       {ValidityRegion{eye, eye, -1}, ValidityRegion{eye, eye, kNan}, ValidityRegion{eye, eye, kInfinity},
        ValidityRegion{eye, eye + Vec3{kNan, 0, 0}, 1}, ValidityRegion{eye, eye + Vec3{0, 0, kInfinity}, 1},
        ValidityRegion{eye, eye + Vec3{1e5, 0, 0}, 1}, ValidityRegion{eye, eye, 1e30}}) {
    horizon.buildFor(region, tiles, {});
    EXPECT_EQ(horizon.hiddenCount(), 0u);
    EXPECT_EQ(horizon.hidden().size(), tiles.size());
  }
  EXPECT_FALSE((ValidityRegion{eye, eye, kNan}.holds(eye)));
  EXPECT_FALSE((ValidityRegion{eye, eye, 5}.holds({kNan, 0, 0})));
}

TEST(MovingHorizon, isDefinedForEyesAndTilesThatAreNone) {
  const Vec3 good = middle(60);
  const LevelCut cut = cutAt(good);
  const std::vector<HorizonTile> tiles = ground().tiles(cut);
  const SurfaceTree tree = SurfaceTree::of(ground().index());
  MovingHorizon moving;
  const auto hiddenAt = [&](Vec3 eye, int columns = 512) {
    const auto hidden = moving.hidden({.eye = eye,
                                       .cut = 1,
                                       .tiles = cut.tiles,
                                       .errorOverDistance = 0.004,
                                       .settings = {.columns = columns}},
                                      tree, [&](std::vector<HorizonTile>& to) { to = tiles; });
    EXPECT_EQ(hidden.size(), cut.tiles.size());
    return std::count(hidden.begin(), hidden.end(), 1);
  };
  for (const Vec3 bad :
       {Vec3{kNan, 0, 0}, Vec3{good.x, good.y, kInfinity}, Vec3{-kInfinity, good.y, good.z}}) {
    EXPECT_GT(hiddenAt(good), 0);
    EXPECT_EQ(hiddenAt(bad), 0);
  }
  // High above all of it, and further away than any of it, there is nothing before the tiles.
  EXPECT_EQ(hiddenAt({good.x, good.y, 6e6}), 0);
  EXPECT_EQ(hiddenAt({good.x, good.y, 1e300}), 0);
  hiddenAt({good.x, good.y, -500});  // below ground: the caller's to refuse
  hiddenAt(ground().relief(0).origin);
  for (const int columns : {-5, 0, 1, 16, 2'000'000'000}) EXPECT_GE(hiddenAt(good, columns), 0);
  EXPECT_GT(hiddenAt(good, 2'000'000'000), 0);

  moving.clear();
  EXPECT_TRUE(
      moving
          .hidden({.eye = good, .tiles = {}, .settings = {}}, SurfaceTree{}, [](std::vector<HorizonTile>&) {})
          .empty());
}

TEST(MovingHorizon, neverHidesTilesThatAreNoSurfaceNorByThem) {
  const Vec3 eye = middle(60);
  const LevelCut cut = cutAt(eye);
  std::vector<HorizonTile> tiles = ground().tiles(cut);
  std::vector<TileRelief> broken(tiles.size());
  MeshRelief nothing;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    broken[i] = *tiles[i].relief;
    const float far = i % 4 == 0 ? std::numeric_limits<float>::infinity() : 3e38f;
    (i % 2 == 0 ? broken[i].z : broken[i].x)[5] = far;
    broken[i].finish(4);
    tiles[i].east = tiles[i].north = nullptr;
    tiles[i].relief = i % 5 == 0 ? nullptr : &broken[i];
    if (i % 5 == 0 && i % 2 == 0) tiles[i].mesh = &nothing;
  }
  Horizon horizon;
  horizon.buildFor({eye, eye + Vec3{30, 0, 0}, 2}, tiles, {});
  EXPECT_EQ(horizon.hiddenCount(), 0u);
}

/// Posts of a grid of degrees in a frame whose origin is far away: they are beside where a plane would have
/// them, by their heights too. What ends at them is asked of every triangle.
class BentGround {
 public:
  static constexpr int kTiles = 8, kCells = 16, kPosts = kTiles * kCells + 1;

  BentGround() : frame_({Degrees{46}, Degrees{8}, Metres{0}}) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int y = 0; y < kPosts; ++y)
      for (int x = 0; x < kPosts; ++x)
        posts_.push_back(
            frame_.fromGeodetic(place(x, y,
                                      500 * std::abs(std::sin(0.11 * x) * std::cos(0.083 * y)) +
                                          180 * std::abs(std::sin(0.31 * x + 0.2 * y)) + 20 * unit(random))));
    reliefs_.resize(std::size_t{kTiles} * kTiles);
    for (int t = 0; t < kTiles * kTiles; ++t) {
      TileRelief& r = reliefs_[static_cast<std::size_t>(t)];
      const int x0 = t % kTiles * kCells, y0 = t / kTiles * kCells;
      r.side = kCells + 1;
      r.origin = post(x0 + 3, y0 + 7);
      for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x) {
          const Vec3 p = post(x0 + x, y0 + y) - r.origin;
          r.x.push_back(static_cast<float>(p.x));
          r.y.push_back(static_cast<float>(p.y));
          r.z.push_back(static_cast<float>(p.z));
        }
      r.finish(4);
    }
  }

  std::vector<HorizonTile> tiles() const {
    std::vector<HorizonTile> tiles;
    for (std::size_t i = 0; i < reliefs_.size(); ++i)
      tiles.push_back({.relief = &reliefs_[i],
                       .mayOcclude = true,
                       .east = i % kTiles + 1 < kTiles ? &reliefs_[i + 1] : nullptr,
                       .north = i + kTiles < reliefs_.size() ? &reliefs_[i + kTiles] : nullptr});
    return tiles;
  }
  Vec3 eyeAt(double x, double y, double heightM) const { return frame_.fromGeodetic(place(x, y, heightM)); }
  Vec3 post(int x, int y) const { return posts_[static_cast<std::size_t>(y * kPosts + x)]; }

  bool isCovered(Vec3 eye, Vec3 p) const {
    const Vec3 d = p - eye;
    const auto meets = [&](Vec3 a, Vec3 b, Vec3 c) {
      const Vec3 u = b - a, v = c - a, h = cross(d, v);
      const double det = dot(u, h);
      if (std::abs(det) < 1e-12) return false;
      const Vec3 from = eye - a, q = cross(from, u);
      const double i = dot(from, h) / det, j = dot(d, q) / det, s = dot(v, q) / det;
      return i >= 0 && j >= 0 && i + j <= 1 && s > 0 && s < 1 - 1e-7;
    };
    for (int y = 0; y + 1 < kPosts; ++y)
      for (int x = 0; x + 1 < kPosts; ++x) {
        const Vec3 sw = post(x, y), se = post(x + 1, y), nw = post(x, y + 1), ne = post(x + 1, y + 1);
        if ((x + y) % 2 == 0 ? meets(sw, se, ne) || meets(sw, ne, nw)
                             : meets(sw, se, nw) || meets(se, ne, nw))
          return true;
      }
    return false;
  }

 private:
  static GeodeticPosition place(double x, double y, double heightM) {
    return {Degrees{46.9 + y * 0.00027}, Degrees{8.9 + x * 0.0004}, Metres{heightM}};
  }

  LocalFrame frame_;
  std::vector<Vec3> posts_;
  std::vector<TileRelief> reliefs_;
};

TEST(MovingHorizon, holdsOnTheBentEarthFarFromTheFramesOrigin) {
  const BentGround ground;
  EXPECT_GT(length(ground.post(0, 0)), 1e5);
  EXPECT_LT(ground.post(0, 0).z, -500) << "the earth has fallen away";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::vector<HorizonTile> tiles = ground.tiles();
  TerrainIndex index;
  constexpr std::uint32_t kNone = TerrainIndex::kNone;
  std::vector<TileDraw> draws;
  for (std::uint32_t i = 0; i < tiles.size(); ++i) {
    index.bounds.push_back({});
    index.errorM.push_back(0);
    index.parent.push_back(kNone);
    index.children.push_back({kNone, kNone, kNone, kNone});
    draws.push_back({.node = i});
  }
  index.neighbours = index.children;
  const SurfaceTree tree = SurfaceTree::of(index);
  std::size_t asked = 0, wrong = 0;
  for (const double heightM : {230.0, 330.0}) {
    MovingHorizon moving;
    for (int frame = 0; frame < 40; ++frame) {
      const Vec3 eye = ground.eyeAt(50 + 0.17 * frame, 57 - 0.02 * frame, heightM);
      const auto hidden = moving.hidden(
          {.eye = eye, .cut = 1, .tiles = draws, .errorOverDistance = 0.004, .settings = {.columns = 1024}},
          tree, [&](std::vector<HorizonTile>& to) { to = tiles; });
      for (int k = 0; k < 12; ++k) {
        const auto t = static_cast<std::size_t>(unit(random) * double(tiles.size()));
        if (hidden[t] == 0) continue;
        const auto in = [&] { return static_cast<int>(unit(random) * (BentGround::kCells + 1)); };
        const Vec3 p = ground.post(static_cast<int>(t % 8) * 16 + in(), static_cast<int>(t / 8) * 16 + in());
        ++asked;
        wrong += !ground.isCovered(eye, p);
      }
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(asked, 60u);
  std::printf("%zu points asked\n", asked);
}

}  // namespace
}  // namespace trimtab
