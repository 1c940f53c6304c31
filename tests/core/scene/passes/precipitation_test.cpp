#include <cmath>
#include <limits>
#include <random>

#include "core/scene/gl/gl_api.h"
#include "core/scene/passes/weather_precipitation.h"
#include "tests/core/scene/passes/falling_scene.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/renderer.h"

namespace trimtab {
namespace {

using Pixels8 = std::vector<std::uint8_t>;

class Falling : public test::FallingScene {
 protected:
  Falling() : FallingScene(PrecipitationForm::effect) {}
  /// Pixels that what falls changes, in the lower third.
  double lowerThird(const FrameRequest& r) {
    const Pixels8 wet = picture(r), without = picture(dry(r));
    const auto third = [](const Pixels8& p) {
      return Pixels8(p.begin(), p.begin() + kWidth * (kHeight / 3) * 4);
    };
    return static_cast<double>(differing(third(wet), third(without))) / (kWidth * (kHeight / 3));
  }
  /// A heading and an error at which so many vertices are in view, within 5 %.
  void reach(FrameRequest& r, double vertices) {
    double inView = 0;
    for (int turn = 0; turn < 12; ++turn) {
      r.attitude.heading = Degrees{30.0 * turn};
      double fine = 0.1, coarse = 50;
      for (int i = 0; i < 10; ++i) {
        r.levers.drawn.errorPx = std::sqrt(fine * coarse);
        inView = static_cast<double>(renderer.draw(dry(r), offscreen->framebuffer()).visible.vertices);
        if (std::abs(inView - vertices) < 0.05 * vertices) return;
        (inView > vertices ? fine : coarse) = r.levers.drawn.errorPx;
      }
    }
    FAIL() << inView;
  }
};

// Document D: right at 76,238 vertices in view; at 82,144 the particles shrink and are gone from the lower
// part.
TEST_F(Falling, fillsTheLowerThirdHoweverManyVerticesAreInView) {
  use(std::make_shared<const test::SyntheticTerrain>(
      32, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, test::mountains));
  for (const Precipitation kind : kKinds) {
    double first = 0;
    for (const double vertices : {76238.0, 82144.0, 140000.0}) {
      auto r = falling(kind, 1);
      ASSERT_NO_FATAL_FAILURE(reach(r, vertices));
      const double share = lowerThird(r);
      std::printf("heavy %s, %.0f vertices: %.1f %% of the lower third\n",
                  kind == Precipitation::rain ? "rain" : "snow", vertices, 100 * share);
      EXPECT_GT(share, 0.5);
      if (first == 0) first = share;
      EXPECT_NEAR(share, first, 0.05);
      // A near plane that moves out with the far one is what cut them off there.
      r.view.nearM = 0.0005 * 100e3;
      EXPECT_NEAR(lowerThird(r), share, 0.05) << "the near plane cuts off what falls before it";
    }
  }
}

TEST_F(Falling, leavesNothingBehindWhenItStops) {
  use(test::syntheticMountains());
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 0.5);
    r.cullingCase = CullingCase::proposed;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.overlays.tileBounds = true;
    const Pixels8 before = picture(dry(r));
    const Pixels8 wet = picture(r);
    EXPECT_GT(differing(before, wet), 1000u);
    for (std::size_t i = 3; i < wet.size(); i += 4) ASSERT_EQ(wet[i], before[i]) << "the picture's own alpha";
    EXPECT_EQ(differing(before, picture(dry(r))), 0u);
    EXPECT_EQ(differing(wet, picture(r)), 0u);
    EXPECT_EQ(differing(before, picture(dry(r))), 0u);
    picture(r);
    for (const GLenum off :
         {GL_BLEND, GL_DEPTH_CLAMP, GL_DEPTH_TEST, GL_VERTEX_PROGRAM_POINT_SIZE, GL_CULL_FACE})
      EXPECT_FALSE(glIsEnabled(off)) << off;
    GLboolean depthMask = GL_FALSE;
    glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
    EXPECT_TRUE(depthMask);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
}

TEST_F(Falling, hidesNothingFromTheDepthMapAndDrawsNoDepth) {
  use(test::syntheticMountains());
  for (const Precipitation kind : kKinds)
    for (int i = 0; i < 4; ++i) {
      auto r = falling(kind, 0.7, 60 + 200 * i);
      r.attitude.heading = Degrees{70.0 * i};
      r.levers.drawn.occlusion = OcclusionResolution{400, 300};
      picture(dry(r));
      const auto metres = renderer.readDistances();
      const Pixels8 frustum = picture(r);
      EXPECT_EQ(renderer.readDistances(), metres);
      r.cullingCase = CullingCase::proposed;
      FrameResult result;
      EXPECT_EQ(differing(frustum, picture(r, &result)), 0u);
      EXPECT_TRUE(result.depthMap.has_value()) << result.note;
    }
}

TEST_F(Falling, isAFunctionOfItsTimeAndNotOfThePictureBefore) {
  use(test::syntheticMountains());
  auto r = falling(Precipitation::rain, 0.6);
  const Pixels8 first = picture(r);
  r.time += 0.05;
  EXPECT_GT(differing(first, picture(r)), 1000u);
  r.attitude.heading = Degrees{200};
  picture(r);
  auto again = falling(Precipitation::rain, 0.6);
  EXPECT_EQ(differing(first, picture(again)), 0u);
  auto second = scene::Offscreen::create(kWidth, kHeight);
  ASSERT_TRUE(second);
  scene::Renderer other;
  ASSERT_TRUE(other.initialize().usable);
  other.setTerrain(database);
  other.draw(again, second.value()->framebuffer());
  EXPECT_EQ(differing(first, other.readPixels(kWidth, kHeight)), 0u);
  other.release();
  offscreen->makeCurrent();
  // Seconds since 1970 are as good as seconds since the start; 700 s are whole periods of heavy rain.
  for (const double time : {1.79e9, -5.0, std::numeric_limits<double>::quiet_NaN()}) {
    again.time = time;
    EXPECT_GT(differing(picture(dry(again)), picture(again)), 1000u) << time;
  }
}

TEST_F(Falling, streaksAlongTheEyesWay) {
  use(test::syntheticMountains());
  auto r = falling(Precipitation::rain, 0.6);
  const Pixels8 still = picture(r);
  r.velocity = Velocity{};
  EXPECT_EQ(differing(still, picture(r)), 0u);
  r.velocity = Velocity{MetresPerSecond{80}, MetresPerSecond{40}, MetresPerSecond{0}};
  EXPECT_GT(differing(still, picture(r)), 1000u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  r.velocity = Velocity{MetresPerSecond{nan}, MetresPerSecond{0}, MetresPerSecond{0}};
  EXPECT_EQ(differing(still, picture(r)), 0u);
}

TEST_F(Falling, streaksByTheEyesWayThroughTheAir) {
  use(test::syntheticMountains());
  auto r = falling(Precipitation::rain, 0.6);
  const Pixels8 still = picture(r);
  // West wind of 20 m/s: air that moves east.
  r.wind = {MetresPerSecond{20}, Degrees{270}, MetresPerSecond{1}};
  EXPECT_GT(differing(still, picture(r)), 1000u);
  r.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{20}, MetresPerSecond{-1}};
  EXPECT_LT(differing(still, picture(r)), 10u) << "an eye that drifts along sees rain fall straight down";
}

TEST_F(Falling, looksAsThePresetSays) {
  use(test::syntheticMountains());
  const auto changed = [&](const Pixels8& a, const Pixels8& b, std::size_t channel) {
    std::size_t n = 0;
    for (std::size_t i = channel; i < a.size(); i += 4) n += a[i] != b[i];
    return n;
  };
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 0.6);
    const auto look = [kind](FrameRequest& of) -> PrecipitationLook& {
      return kind == Precipitation::rain ? of.rain : of.snow;
    };
    const Pixels8 before = picture(r), without = picture(dry(r));
    auto red = r;
    look(red).red = Ratio{0.2};
    EXPECT_GT(changed(before, picture(red), 0), 1000u);
    EXPECT_EQ(changed(before, picture(red), 1), 0u);
    EXPECT_EQ(changed(before, picture(red), 2), 0u);
    auto large = r;
    look(large).size = Ratio{3};
    const auto strength = [&](const Pixels8& p) {
      double sum = 0;
      for (std::size_t i = 0; i < p.size(); ++i) sum += std::abs(double{1} * p[i] - without[i]);
      return sum;
    };
    EXPECT_GT(strength(picture(large)), 1.5 * strength(before));
    auto fast = r;
    look(fast).fallSpeed = Ratio{2};
    EXPECT_GT(differing(before, picture(fast)), 1000u);
  }
}

TEST_F(Falling, isRunOnlyWhereSomethingFalls) {
  use(test::syntheticMountains());
  auto r = falling(Precipitation::none, 1);
  const auto passes = [&] { return renderer.draw(r, offscreen->framebuffer()); };
  EXPECT_EQ(passes().counters.precipitationPasses, 0u);
  r.decision.weather.precipitation = Precipitation::rain;
  for (const double none : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    r.decision.weather.density = none;
    EXPECT_EQ(passes().counters.precipitationPasses, 0u) << none;
  }
  r.decision.weather.density = 0.3;
  EXPECT_EQ(passes().counters.precipitationPasses, 1u);
  EXPECT_EQ(passes().counters.precipitationPasses, 2u);
  EXPECT_EQ(passes().counters.depthMapsDrawn, 0u);
  r.decision.weather.density = 7;
  const Pixels8 most = picture(r);
  r.decision.weather.density = 1;
  EXPECT_EQ(differing(most, picture(r)), 0u) << "no denser than heavy";
}

TEST_F(Falling, fallsWithoutTerrainToo) {
  auto r = request({Degrees{36}, Degrees{128}, Metres{1000}}, {});
  r.precipitationForm = PrecipitationForm::effect;
  r.decision.weather.precipitation = Precipitation::snow;
  r.decision.weather.density = 1;
  EXPECT_GT(differing(picture(dry(r)), picture(r)), 10000u);
}

TEST_F(Falling, leavesNothingInTheContext) {
  use(test::syntheticMountains());
  const auto alive = [] {
    std::array<std::size_t, 2> n{};
    for (GLuint id = 1; id < 4000; ++id) {
      n[0] += glIsProgram(id) == GL_TRUE;
      n[1] += glIsBuffer(id) == GL_TRUE;
    }
    return n;
  };
  const auto drawAndRelease = [&] {
    for (const Precipitation kind : kKinds) picture(falling(kind, 0.4));
    const auto during = alive();
    renderer.release();
    const auto after = alive();
    EXPECT_GT(during[0], after[0]);
    EXPECT_TRUE(renderer.initialize().usable);
    return after;
  };
  EXPECT_EQ(drawAndRelease(), (std::array<std::size_t, 2>{0, 0}));
  EXPECT_EQ(drawAndRelease(), (std::array<std::size_t, 2>{0, 0}));
}

TEST(PrecipitationLattice, standsStillInTheWorld) {
  const Vec3 cell{4, 4, 5};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-60e3, 60e3);
  const auto whole = [](double x, double unit) { return std::abs(x / unit - std::round(x / unit)) * unit; };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 eye{place(random), place(random), place(random)};
    const Vec3 corner = eye + scene::latticeFromEye(eye, cell);
    EXPECT_LT(whole(corner.x, scene::kCellsUntilSame * cell.x), 1e-6);
    EXPECT_LT(whole(corner.y, scene::kCellsUntilSame * cell.y), 1e-6);
    EXPECT_LT(whole(corner.z, cell.z), 1e-6);
    EXPECT_LE(length(corner - eye), 600) << "near enough for floats";
  }
}

/// Where every flake is, by what the effect and the shaders promise: cells of a lattice that stands in the
/// air, a pattern that is the same in each but for its own shift, falling.
TEST_F(Falling, isWhereTheAirsLatticeSaysFromAnyEye) {
  use(test::syntheticMountains());
  constexpr double kDensity = 0.06;
  // osgParticle::PrecipitationEffect::snow(intensity).
  const Vec3 cell{5 / (0.25 + kDensity), 5 / (0.25 + kDensity), 5};
  const int count = static_cast<int>(kDensity * 8.2 * cell.x * cell.y * cell.z);
  std::vector<Vec3> pattern;
  std::mt19937 random(20140908);
  const auto unit = [&random] { return static_cast<double>(random() >> 8) * 0x1p-24; };
  for (int i = 0; i < count; ++i) {
    const double x = unit(), y = unit(), z = unit();
    pattern.push_back({x, y, z});
  }
  const auto wrapped = [](double x) { return x - std::floor(x); };

  struct Case {
    double east, north, fallSpeed;
    Vec3 drift;
  };
  for (const auto& [east, north, fallSpeed, drift] :
       {Case{0.5, 0.5, 1, {}}, Case{0.31, 0.64, 1, {}}, Case{0.77, 0.22, 1, {}}, Case{0.5, 0.5, 3, {}},
        Case{0.4, 0.6, 1, {-1234.5, 777.25, 3.5}}}) {
    const double speed = (0.75 + 0.25 * kDensity) * fallSpeed;
    auto r = falling(Precipitation::snow, kDensity, 3000);
    r.eye = over(east, north, 3000);
    r.attitude = {Degrees{123}, Degrees{4}, Degrees{0}};
    r.snow.fallSpeed = Ratio{fallSpeed};
    r.airDrift = transposed(database->index().frame.ecefToLocal()) * drift;
    const Pixels8 snow = picture(r), without = picture(dry(r));
    const LocalFrame& frame = database->index().frame;
    const Vec3 inWorld = frame.fromGeodetic(r.eye), eye = inWorld - drift;
    const Mat3 axes = eyeAxes(frame, r.eye, r.attitude);
    const auto low = [&](double e, double size) { return std::floor(e / size) * size; };
    std::size_t expected = 0, found = 0, white = 0;
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j)
        for (int k = 0; k <= 1; ++k) {
          const Vec3 corner{low(eye.x, cell.x) + i * cell.x, low(eye.y, cell.y) + j * cell.y,
                            low(eye.z, cell.z) + k * cell.z};
          // The effect's number of this cell, from the lattice's corner next to the eye.
          const Vec3 origin = eye + scene::latticeFromEye(eye, cell);
          const double column = std::round((corner.x - origin.x) / cell.x),
                       row = std::round((corner.y - origin.y) / cell.y);
          const double own = wrapped(column * 0.43 + row * 0.64);
          for (const Vec3& p : pattern) {
            const Vec3 flake{corner.x + wrapped(p.x + 7 * own) * cell.x,
                             corner.y + wrapped(p.y + 3 * own) * cell.y,
                             corner.z + cell.z - wrapped(r.time * speed / cell.z - own - p.z) * cell.z};
            const Vec3 e = axes * (flake - eye);
            if (!(-e.z > 2.5 && length(e) < 14)) continue;
            const double x = (e.x / -e.z - r.view.left) / (r.view.right - r.view.left) * kWidth,
                         y = (e.y / -e.z - r.view.bottom) / (r.view.top - r.view.bottom) * kHeight;
            if (!(x > 2 && y > 2 && x < kWidth - 2 && y < kHeight - 2)) continue;
            const std::size_t at = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
            ++expected;
            found += !std::equal(&snow[at], &snow[at + 3], &without[at]);
          }
        }
    for (std::size_t i = 0; i < snow.size(); i += 4)
      white += !std::equal(&snow[i], &snow[i + 3], &without[i]);
    std::printf("%zu of %zu flakes where they must be; they cover %.1f %% of the picture\n", found, expected,
                100.0 * static_cast<double>(white) / (kWidth * kHeight));
    ASSERT_GT(expected, 100u);
    EXPECT_GE(found * 100, expected * 97);
    EXPECT_LT(white * 5, std::size_t{kWidth} * kHeight) << "so thick that any place would do";
  }
}

}  // namespace
}  // namespace trimtab
