#include "core/terrain/ground/paint.h"

#include <cmath>
#include <numbers>
#include <set>

#include "ground_support.h"
#include "tests/core/terrain/ground/build_and_open.h"

namespace trimtab::terrain {
namespace {

using test::GroundLand;
using test::Picture;

constexpr std::array<std::uint8_t, 3> kGrass{90, 140, 60}, kRoad{250, 20, 30};

/// Corners in posts.
GroundTriangle triangle(const PostGrid& posts, std::array<std::array<double, 2>, 3> corners,
                        std::array<std::uint8_t, 3> colour, LineFeature line = LineFeature::none) {
  GroundTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.longitude[k] = posts.longitude(corners[k][0]);
    t.latitude[k] = posts.latitude(corners[k][1]);
  }
  t.colour = colour;
  t.line = line;
  return t;
}

/// A strip from one post to another as two triangles.
void addStrip(std::vector<GroundTriangle>& all, const PostGrid& posts, double x0, double y0, double x1,
              double y1, double width, std::array<std::uint8_t, 3> colour, LineFeature line) {
  const double length = std::hypot(x1 - x0, y1 - y0), nx = -(y1 - y0) / length * width / 2,
               ny = (x1 - x0) / length * width / 2;
  all.push_back(
      triangle(posts, {{{x0 - nx, y0 - ny}, {x1 - nx, y1 - ny}, {x1 + nx, y1 + ny}}}, colour, line));
  all.push_back(
      triangle(posts, {{{x0 - nx, y0 - ny}, {x1 + nx, y1 + ny}, {x0 + nx, y0 + ny}}}, colour, line));
}

bool isRoad(const GroundTexel& t) {
  return t.red > 200 && t.green < 80;
}

/// All of them, wherever they are asked for.
class Everywhere final : public GroundTriangles {
 public:
  explicit Everywhere(std::span<const GroundTriangle> triangles) : triangles_(triangles) {}
  Result<std::vector<GroundTriangle>> over(const Rectangle&) const override {
    return std::vector<GroundTriangle>(triangles_.begin(), triangles_.end());
  }

 private:
  std::span<const GroundTriangle> triangles_;
};

std::shared_ptr<const GroundPyramid> painted(GroundLand& land, std::span<const GroundTriangle> triangles,
                                             double texels) {
  GroundSources sources = land.sources();
  const Everywhere all(triangles);
  sources.triangles = &all;
  sources.texelsPerPost = texels;
  auto pyramid = test::buildAndOpenGround(sources);
  EXPECT_TRUE(pyramid) << toString(pyramid.findings());
  return pyramid ? *pyramid : nullptr;
}

TEST(GroundPaint, everyTexelHasTheTriangleOverItsMiddle) {
  GroundLand land(700, 600);
  const PostGrid& posts = land.grid.posts;
  // A fan about a place, each of its own colour: they cover all without gap or overlap.
  std::vector<GroundTriangle> triangles;
  constexpr int kParts = 23;
  const double cx = 333.3, cy = 281.7, far = 3000;
  const auto corner = [&](int k) {
    const double a = 2 * std::numbers::pi * k / kParts;
    return std::array<double, 2>{cx + far * std::cos(a), cy + far * std::sin(a)};
  };
  for (int k = 0; k < kParts; ++k)
    triangles.push_back(triangle(posts, {{{cx, cy}, corner(k), corner(k + 1)}},
                                 {static_cast<std::uint8_t>(10 * k + 5), 99, 77}));
  for (const double texels : {1.0, 2.0}) {
    const auto pyramid = painted(land, triangles, texels);
    ASSERT_TRUE(pyramid);
    const Picture finest = test::readLevel(*pyramid, 0);
    int between = 0;
    for (std::uint32_t r = 0; r < finest.rows; ++r)
      for (std::uint32_t c = 0; c < finest.columns; ++c) {
        double turn = std::atan2(r / texels - cy, c / texels - cx) / (2 * std::numbers::pi) * kParts;
        if (turn < 0) turn += kParts;
        ASSERT_EQ(finest.at(c, r).green, 99);
        if (std::abs(turn - std::round(turn)) < 1e-3) {
          ++between;
          continue;
        }
        ASSERT_EQ(finest.at(c, r).red, 10 * static_cast<int>(turn) + 5) << c << ", " << r;
      }
    EXPECT_LT(between, 5000);
  }
}

TEST(GroundPaint, aRoadIsAWholeLineUntilHalfATexelIsWider) {
  GroundLand land(900, 800);
  const PostGrid& posts = land.grid.posts;
  for (const double width : {0.1, 0.4, 0.8, 1.7, 4.0})
    for (const double turn : {0.0, 0.02, 0.4, 0.785398, 1.2, 1.5708}) {
      std::vector<GroundTriangle> triangles;
      addStrip(triangles, posts, -500, 400, 1500, 400, 3000, kGrass, LineFeature::none);
      const double dx = 330 * std::cos(turn), dy = 330 * std::sin(turn);
      addStrip(triangles, posts, 450 - dx, 400 - dy, 450 + dx, 400 + dy, width, kRoad, LineFeature::road);
      const auto pyramid = painted(land, triangles, 1);
      ASSERT_TRUE(pyramid);
      for (std::uint32_t l = 0; l < 3; ++l) {
        const double texel = std::ldexp(1.0, static_cast<int>(l));
        if (l > 0 && width < texel / 2) break;
        SCOPED_TRACE(testing::Message() << "width " << width << ", turned " << turn << ", level " << l);
        const Picture level = test::readLevel(*pyramid, l);
        // Walking along it, one texel after the other is road, and next to the one before.
        const bool steep = std::abs(dy) > std::abs(dx);
        const double long_ = steep ? dy : dx, short_ = steep ? dx : dy;
        const int steps = static_cast<int>(2 * std::abs(long_) / texel) - 2;
        std::int64_t road = 0;
        for (int i = 1; i < steps; ++i) {
          const double along = (steep ? 400 : 450) - std::abs(long_) + i * texel;
          const double across = (steep ? 450 : 400) + (along - (steep ? 400 : 450)) * short_ / long_;
          const auto at = [&](double post) { return static_cast<std::uint32_t>((post + 0.5) / texel); };
          const std::uint32_t a = at(along), b = at(across);
          int found = 0;
          for (int k = -1; k <= 1; ++k) {
            const auto bk = static_cast<std::uint32_t>(static_cast<int>(b) + k);
            if (isRoad(steep ? level.at(bk, a) : level.at(a, bk))) ++found;
          }
          ASSERT_GE(found, 1) << "step " << i;
          road += found;
        }
        if (width < 1 && l == 0) {
          EXPECT_LE(road, 2 * steps);
        }
      }
    }
}

TEST(GroundPaint, aRoadFadesWhereItIsNarrower) {
  GroundLand land(2600, 200);
  std::vector<GroundTriangle> triangles;
  addStrip(triangles, land.grid.posts, -500, 100, 3500, 100, 3000, kGrass, LineFeature::none);
  addStrip(triangles, land.grid.posts, 50, 100.2, 2550, 100.2, 1, kRoad, LineFeature::road);
  const auto pyramid = painted(land, triangles, 1);
  ASSERT_TRUE(pyramid);
  double before = 256;
  for (std::uint32_t l = 0; l < pyramid->shape().levels.size(); ++l) {
    const Picture level = test::readLevel(*pyramid, l);
    const std::uint32_t column = 1000u >> l;
    int reddest = 0;
    for (std::uint32_t r = 0; r < level.rows; ++r) reddest = std::max<int>(reddest, level.at(column, r).red);
    EXPECT_LE(reddest, before);
    before = reddest;
    if (l <= 1) {
      EXPECT_EQ(reddest, kRoad[0]);
    }
  }
  EXPECT_LT(before, 0.7 * kRoad[0]);
}

TEST(GroundPaint, imagesLieOverMaterials) {
  GroundLand land(300, 300, 10, 50, 0.001);
  test::ScratchDir dir;
  test::RasterRecipe picture;
  picture.bands = 3;
  picture.type = GDT_Byte;
  picture.columns = 150, picture.rows = 300;
  picture.west = 10 - 0.0005, picture.north = 50 + 0.2995, picture.step = 0.001;
  picture.value = [](int, int, int) { return 33; };
  std::vector<GroundTriangle> triangles;
  addStrip(triangles, land.grid.posts, -500, 100, 900, 100, 3000, kGrass, LineFeature::none);
  addStrip(triangles, land.grid.posts, 5, 150, 295, 150, 1, kRoad, LineFeature::road);
  GroundSources sources = land.sources();
  sources.images = {test::writeRaster(dir / "half.tif", picture)};
  const Everywhere all(triangles);
  sources.triangles = &all;
  sources.texelsPerPost = 1;
  const auto pyramid = test::buildAndOpenGround(sources);
  ASSERT_TRUE(pyramid);
  for (std::uint32_t l = 0; l < 2; ++l) {
    const Picture level = test::readLevel(**pyramid, l);
    EXPECT_EQ(level.at(50 >> l, 150 >> l).red, 33);
    EXPECT_EQ(level.at(50 >> l, 50 >> l).red, 33);
    EXPECT_TRUE(isRoad(level.at(250 >> l, 150 >> l)));
    EXPECT_EQ(level.at(250 >> l, 50 >> l).green, kGrass[1]);
  }
}

}  // namespace
}  // namespace trimtab::terrain
