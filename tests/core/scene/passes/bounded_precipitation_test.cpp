#include <cmath>
#include <cstdio>
#include <limits>

#include "core/scene/gl/gl_api.h"
#include "core/scene/passes/weather_precipitation.h"
#include "tests/core/scene/passes/falling_scene.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using Pixels8 = std::vector<std::uint8_t>;

class BoundedPrecipitation : public test::FallingScene {
 protected:
  BoundedPrecipitation() : FallingScene(PrecipitationForm::bounded) {}
  void SetUp() override {
    FallingScene::SetUp();
    if (offscreen) use(test::syntheticMountains());
  }
  /// The sum of all that an image's colours differ from those in dry air.
  double seen(const FrameRequest& r) {
    const Pixels8 wet = picture(r), without = picture(dry(r));
    double sum = 0;
    for (std::size_t i = 0; i < wet.size(); ++i) sum += std::abs(double{1} * wet[i] - without[i]);
    return sum;
  }
};

TEST_F(BoundedPrecipitation, isAFunctionOfItsRequestAlone) {
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 1);
    const Pixels8 first = picture(r);
    r.time += 0.05;
    EXPECT_GT(differing(first, picture(r)), 1000u);
    r.attitude.heading = Degrees{200};
    picture(r);
    EXPECT_EQ(differing(first, picture(falling(kind, 1))), 0u);
    auto second = scene::Offscreen::create(kWidth, kHeight);
    ASSERT_TRUE(second);
    scene::Renderer other;
    ASSERT_TRUE(other.initialize().usable);
    other.setTerrain(database);
    other.draw(falling(kind, 1), second.value()->framebuffer());
    EXPECT_EQ(differing(first, other.readPixels(kWidth, kHeight)), 0u);
    other.release();
    offscreen->makeCurrent();
  }
}

TEST_F(BoundedPrecipitation, isDrawnOnlyWhereSomethingFalls) {
  const auto counted = [&](const FrameRequest& r) {
    const FrameCounters before = renderer.draw(dry(r), offscreen->framebuffer()).counters;
    const FrameCounters after = renderer.draw(r, offscreen->framebuffer()).counters;
    return std::array{after.precipitationPasses - before.precipitationPasses,
                      after.particlesDrawn - before.particlesDrawn};
  };
  for (const Precipitation kind : kKinds) {
    for (const double none : {0.0, -1.0, kNan})
      EXPECT_EQ(counted(falling(kind, none)), (std::array<std::uint64_t, 2>{0, 0})) << none;
    const auto heavy = counted(falling(kind, 1));
    EXPECT_EQ(heavy[0], 1u);
    EXPECT_GT(heavy[1], 500u);
    auto r = falling(kind, 1);
    r.precipitationForm = PrecipitationForm::effect;
    EXPECT_EQ(counted(r), (std::array<std::uint64_t, 2>{1, 0}));
  }
}

TEST_F(BoundedPrecipitation, leavesNothingBehindWhenItStops) {
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 1);
    r.cullingCase = CullingCase::proposed;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.overlays.tileBounds = true;
    const Pixels8 before = picture(dry(r));
    const auto metres = renderer.readDistances();
    const Pixels8 wet = picture(r);
    EXPECT_EQ(renderer.readDistances(), metres) << "it draws no depth";
    EXPECT_GT(differing(before, wet), 1000u);
    for (std::size_t i = 3; i < wet.size(); i += 4) ASSERT_EQ(wet[i], before[i]) << "the image's own alpha";
    EXPECT_EQ(differing(before, picture(dry(r))), 0u);
    EXPECT_EQ(differing(wet, picture(r)), 0u);
    for (const GLenum off : {GL_BLEND, GL_DEPTH_CLAMP, GL_DEPTH_TEST, GL_CULL_FACE})
      EXPECT_FALSE(glIsEnabled(off)) << off;
    GLboolean depthMask = GL_FALSE;
    glGetBooleanv(GL_DEPTH_WRITEMASK, &depthMask);
    EXPECT_TRUE(depthMask);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
}

TEST_F(BoundedPrecipitation, isHiddenBehindWhatIsNearer) {
  // From just above the ground straight down: next to nothing has room to fall there.
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 1);
    const double open = seen(r);
    r.eye = over(0.5, 0.5, 2);
    r.attitude.pitch = Degrees{-90};
    EXPECT_LT(seen(r), open / 3);
  }
}

TEST_F(BoundedPrecipitation, isSeenLessWithLessDensity) {
  for (const Precipitation kind : kKinds) {
    double before = 0;
    for (const double density : {0.1, 0.25, 0.5, 1.0}) {
      const double now = seen(falling(kind, density));
      EXPECT_GT(now, before * 1.2) << density;
      before = now;
    }
  }
}

/// What a lever takes off the cost of rain must not look like less rain. Flakes are nearly opaque, so fewer
/// of them cannot be made up for.
TEST_F(BoundedPrecipitation, looksAboutAsDenseAtAnyShareAndRenderScale) {
  for (const Precipitation kind : kKinds)
    for (const double density : {0.25, 1.0}) {
      auto r = falling(kind, density);
      const double whole = seen(r);
      for (const double share : {0.75, 0.5, 0.25}) {
        r.levers.drawn.particleShare = share;
        const double least = kind == Precipitation::rain ? 0.6 : 0.15 + 0.75 * share;
        const double left = seen(r) / whole;
        std::printf("%s of %g: %.2f at share %g\n", kind == Precipitation::rain ? "rain" : "snow", density,
                    left, share);
        EXPECT_GT(left, least) << share;
        EXPECT_LT(left, 1.3) << share;
      }
      r.levers.drawn.particleShare = 0;
      EXPECT_EQ(seen(r), 0);
      r.levers.drawn.particleShare = 1;
      for (const double scale : {0.7, 0.5}) {
        r.levers.drawn.renderScale = scale;
        const double left = seen(r) / whole;
        std::printf("%s of %g: %.2f at render scale %g\n", kind == Precipitation::rain ? "rain" : "snow",
                    density, left, scale);
        EXPECT_NEAR(left, 1, 0.45) << scale;
      }
      r.levers.drawn.renderScale = 1;
      EXPECT_EQ(seen(r), whole);
    }
}

/// The published effect covers nearly every pixel with flakes, so that heavy snow is a noise without a view.
TEST_F(BoundedPrecipitation, heavySnowLeavesMostOfTheImageToSee) {
  const auto coveredShare = [this](PrecipitationForm form) {
    auto r = falling(Precipitation::snow, 1);
    r.precipitationForm = form;
    constexpr int kSeen = 8;
    const Pixels8 snow = picture(r), without = picture(dry(r));
    std::size_t covered = 0;
    for (std::size_t i = 0; i < snow.size(); i += 4)
      covered += std::abs(int{snow[i + 1]} - without[i + 1]) > kSeen;
    return 4.0 * static_cast<double>(covered) / static_cast<double>(snow.size());
  };
  const double bounded = coveredShare(PrecipitationForm::bounded),
               effect = coveredShare(PrecipitationForm::effect);
  EXPECT_GT(bounded, 0.01);
  EXPECT_LT(bounded, 0.25);
  EXPECT_GT(effect, 2 * bounded) << "or this test shows nothing";
}

TEST_F(BoundedPrecipitation, fadesInWithoutAStepAndOutAlike) {
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 1);
    const double full = seen(r);
    double before = 0;
    for (int i = 1; i <= 20; ++i) {
      r.fading = FadingPrecipitation{kind, 1, 0.05 * i};
      const double now = seen(r);
      EXPECT_GE(now, before * 0.99) << i;
      EXPECT_LE(now - before, full * 0.15) << i;
      before = now;
    }
    EXPECT_EQ(before, full);
    // The decision is dry already, and what is left still falls.
    auto ending = dry(r);
    ending.fading = FadingPrecipitation{kind, 1, 0.5};
    r.fading = ending.fading;
    EXPECT_EQ(differing(picture(ending), picture(r)), 0u);
    ending.fading->amount = 0;
    EXPECT_EQ(differing(picture(ending), picture(dry(falling(kind, 1)))), 0u);
    // The published form knows no fading.
    r = falling(kind, 1);
    r.precipitationForm = PrecipitationForm::effect;
    const Pixels8 published = picture(r);
    r.fading = FadingPrecipitation{kind, 1, 0.5};
    EXPECT_EQ(differing(published, picture(r)), 0u);
  }
}

TEST_F(BoundedPrecipitation, isDefinedForAnyTimeWindAndVelocity) {
  for (const Precipitation kind : kKinds)
    for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1.79e9, 1e300, -5.0}) {
      auto r = falling(kind, 1);
      r.time = bad;
      r.airDrift = {bad, 0, bad};
      r.wind = {MetresPerSecond{bad}, Degrees{bad}, MetresPerSecond{0}};
      r.velocity = Velocity{MetresPerSecond{bad}, MetresPerSecond{0}, MetresPerSecond{0}};
      const Pixels8 wet = picture(r);
      EXPECT_GT(differing(picture(dry(r)), wet), 1000u) << bad;
      EXPECT_EQ(differing(wet, picture(r)), 0u) << bad;
      EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
}

TEST_F(BoundedPrecipitation, looksAsThePresetSays) {
  for (const Precipitation kind : kKinds) {
    auto r = falling(kind, 0.6);
    const Pixels8 before = picture(r);
    PrecipitationLook& look = kind == Precipitation::rain ? r.rain : r.snow;
    const PrecipitationLook plain = look;
    look.red = Ratio{0.2};
    const Pixels8 red = picture(r);
    std::array<std::size_t, 3> changed{};
    for (std::size_t i = 0; i < red.size(); ++i)
      if (i % 4 < 3) changed[i % 4] += red[i] != before[i];
    EXPECT_GT(changed[0], 1000u);
    EXPECT_EQ(changed[1] + changed[2], 0u);
    look = plain;
    const double small = seen(r);
    look.size = Ratio{3};
    EXPECT_GT(seen(r), 1.3 * small);
    look = plain;
    look.fallSpeed = Ratio{2};
    EXPECT_GT(differing(before, picture(r)), 1000u);
  }
}

TEST_F(BoundedPrecipitation, streaksByTheEyesWayThroughTheAir) {
  auto r = falling(Precipitation::rain, 0.6);
  const Pixels8 still = picture(r);
  r.velocity = Velocity{};
  EXPECT_EQ(differing(still, picture(r)), 0u);
  r.wind = {MetresPerSecond{20}, Degrees{270}, MetresPerSecond{0}};
  EXPECT_GT(differing(still, picture(r)), 1000u);
  r.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{20}, MetresPerSecond{0}};
  EXPECT_LT(differing(still, picture(r)), 10u) << "an eye that drifts along sees rain fall straight down";
}

/// The reference image holds all that falls, in the form that is drawn.
TEST_F(BoundedPrecipitation, countsAShareThatIsLeftOutAsError) {
  scene::ErrorMeter meter;
  ASSERT_TRUE(meter.initialize().usable);
  meter.setTerrain(database);
  auto r = falling(Precipitation::snow, 1);
  const double whole = meter.measure(r, nullptr, nullptr).flip;
  r.levers.drawn.particleShare = 0.25;
  EXPECT_GT(meter.measure(r, nullptr, nullptr).flip, whole + 0.005);
  r.levers.drawn.particleShare = 1;
  r.precipitationForm = PrecipitationForm::effect;
  EXPECT_LT(meter.measure(r, nullptr, nullptr).flip, whole + 0.005) << "a reference of the other form";
  meter.release();
}

TEST_F(BoundedPrecipitation, worksAtAnySizeAndWithoutTerrain) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {641, 359}, {1023, 17}}) {
    auto r = falling(Precipitation::snow, 1);
    r.view.widthPx = width;
    r.view.heightPx = height;
    EXPECT_EQ(picture(r).size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
  use(nullptr);
  auto r = request({Degrees{36}, Degrees{128}, Metres{1000}}, {});
  r.decision.weather.precipitation = Precipitation::snow;
  r.decision.weather.density = 1;
  EXPECT_GT(differing(picture(dry(r)), picture(r)), 10000u);
}

TEST_F(BoundedPrecipitation, leavesNothingInTheContext) {
  const auto alive = [] {
    std::size_t n = 0;
    for (GLuint id = 1; id < 4000; ++id)
      n += std::size_t{glIsProgram(id) == GL_TRUE} + (glIsBuffer(id) == GL_TRUE) +
           (glIsTexture(id) == GL_TRUE) + (glIsVertexArray(id) == GL_TRUE);
    return n;
  };
  const auto drawAndRelease = [&] {
    for (const Precipitation kind : kKinds) picture(falling(kind, 1));
    renderer.release();
    const std::size_t after = alive();
    EXPECT_TRUE(renderer.initialize().usable);
    return after;
  };
  const std::size_t first = drawAndRelease();
  EXPECT_EQ(drawAndRelease(), first);
}

}  // namespace
}  // namespace trimtab
