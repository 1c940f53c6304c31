#include <cmath>

#include "core/scene/passes/weather_air.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/overlay_colours.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using test::SceneTest;
using Pixels8 = std::vector<std::uint8_t>;

/// What is left of a contrast at the visibility; 0.02 is 5 of 255 levels.
constexpr double kThreshold = 0.02;

WeatherDecision fog(double visibilityM, double farM = kInfinity) {
  WeatherDecision w;
  w.fogged = true;
  w.visibilityM = visibilityM;
  w.extinctionPerM = -std::log(kThreshold) / visibilityM;
  w.farM = farM;
  return w;
}

/// The fog's colour as weather_air.h describes it, level 0..255.
std::array<double, 3> fogLevels(double extinction) {
  const double grey = 1 - std::exp(-extinction * 1500);
  constexpr std::array<double, 3> kThin{0.74, 0.80, 0.86}, kThick{0.70, 0.72, 0.74};
  std::array<double, 3> levels{};
  for (std::size_t c = 0; c < 3; ++c) levels[c] = 255 * (kThin[c] + grey * (kThick[c] - kThin[c]));
  return levels;
}

class Weather : public SceneTest {
 protected:
  FrameRequest level(double aboveM, double heading = 30, double pitch = -5) const {
    auto r = request(over(0.5, 0.5, aboveM), {Degrees{heading}, Degrees{pitch}, Degrees{0}});
    r.cullingCase = CullingCase::view_frustum;
    return r;
  }
  /// How many of `shown`'s pixels are not what exponential extinction makes of `clear`'s, by distances.
  static std::size_t unlikeTheFormula(const Pixels8& clear, const Pixels8& shown,
                                      const std::vector<float>& metres, double extinction, double cutM) {
    const auto target = fogLevels(extinction);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < metres.size(); ++i) {
      const double d = double{metres[i]};
      if (!(d < cutM * (1 - scene::kCutFade))) continue;  // sky, or where the rest fades
      const double left = std::exp(-extinction * d);
      bool same = true;
      for (std::size_t c = 0; c < 3; ++c)
        same = same &&
               std::abs(target[c] + (double(clear[4 * i + c]) - target[c]) * left - shown[4 * i + c]) <= 1;
      wrong += !same;
    }
    return wrong;
  }
};

TEST(Air, takesAnyDecision) {
  struct Case {
    const char* name;
    bool fogged;
    double extinction, farM;
    bool clear;
  };
  for (const Case& c :
       {Case{"clear", false, 0, kInfinity, true}, Case{"numbers without fog", false, 1e-3, kInfinity, true},
        Case{"fog", true, 1e-3, kInfinity, false}, Case{"no number", true, kNan, kNan, true},
        Case{"negative", true, -1, kInfinity, true}, Case{"visibility 0", true, kInfinity, 0, false},
        Case{"cut alone", false, 0, 5000, false}, Case{"cut below 0", false, 0, -3, false}}) {
    WeatherDecision w;
    w.fogged = c.fogged;
    w.extinctionPerM = c.extinction;
    w.farM = c.farM;
    const scene::Air air = scene::airOf(w, w.farM);
    EXPECT_EQ(air.clear, c.clear) << c.name;
    EXPECT_TRUE(std::isfinite(air.extinction) && air.extinction >= 0) << c.name;
    EXPECT_TRUE(std::isfinite(air.fadePerM) && air.fadePerM > 0 && air.cutM > 0) << c.name;
  }
}

TEST_F(Weather, isTheFormulaAtEveryPixelOfTheGround) {
  use(test::syntheticMountains());
  for (const double above : {60.0, 900.0}) {
    auto r = level(above);
    const Pixels8 clear = picture(r);
    const auto metres = renderer.readDistances();
    for (const double visibility : {50.0, 300.0, 2000.0, 9000.0, 40e3, 300e3}) {
      r.decision.weather = fog(visibility);
      r.levers.drawn.farM = r.decision.weather.farM;
      const Pixels8 shown = picture(r);
      EXPECT_EQ(unlikeTheFormula(clear, shown, metres, r.decision.weather.extinctionPerM, kInfinity), 0u)
          << visibility << " m of visibility from " << above << " m";
      // Of any other visibility it must not be the picture, or the check sees nothing.
      if (visibility < 2000) continue;
      EXPECT_GT(unlikeTheFormula(clear, shown, metres, 0.8 * r.decision.weather.extinctionPerM, kInfinity),
                0u);
    }
  }
}

TEST_F(Weather, isTheFormulaInTheSkyAndGreyAllOverInThickFog) {
  use(test::syntheticMountains());
  auto r = level(900, 30, 10);
  const Pixels8 clear = picture(r);
  const auto metres = renderer.readDistances();
  for (const double visibility : {50.0, 2000.0, 20e3, 200e3}) {
    r.decision.weather = fog(visibility);
    r.levers.drawn.farM = r.decision.weather.farM;
    const double extinction = r.decision.weather.extinctionPerM;
    const auto target = fogLevels(extinction);
    const Pixels8 shown = picture(r);
    std::size_t sky = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        if (std::isfinite(metres[i])) continue;
        ++sky;
        // The view is level but for its pitch, so up is up * cos - forward * sin of it.
        const double u = r.view.left + (r.view.right - r.view.left) * (x + 0.5) / kWidth,
                     v = r.view.bottom + (r.view.top - r.view.bottom) * (y + 0.5) / kHeight;
        const double pitch = 10 * M_PI / 180;
        const double sine = (v * std::cos(pitch) + std::sin(pitch)) / std::sqrt(1 + u * u + v * v);
        const double height = r.eye.height.value(), dip = std::acos(6371e3 / (6371e3 + height));
        const double elevation = sine + dip;
        const double left = std::exp(-extinction * (elevation > 0 ? scene::kFogTopM : height) /
                                     std::max(std::abs(elevation), 1e-5));
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(target[c] + (double(clear[4 * i + c]) - target[c]) * left, shown[4 * i + c], 1.5)
              << visibility << ": " << x << ", " << y;
      }
    EXPECT_GT(sky, std::size_t{kWidth} * kHeight / 4);
    if (visibility > 50) continue;
    for (std::size_t i = 1; i < metres.size(); ++i)
      ASSERT_LE(largestStep(shown, 0, i), 1) << "a wall of grey";
  }
}

TEST_F(Weather, leavesNothingBehindInClearAir) {
  use(test::syntheticMountains());
  auto r = level(400);
  r.cullingCase = CullingCase::proposed;
  r.levers.drawn.occlusion = OcclusionResolution{320, 240};
  const Pixels8 clear = picture(r);
  for (const double visibility : {50.0, 9000.0}) {
    auto foggy = r;
    foggy.decision.weather = fog(visibility, visibility);
    foggy.levers.drawn.farM = foggy.decision.weather.farM;
    EXPECT_GT(differing(clear, picture(foggy)), 0u);
    EXPECT_EQ(differing(clear, picture(r)), 0u);
  }
}

TEST_F(Weather, isTheSamePictureInAllThreeCullingCases) {
  use(test::syntheticMountains());
  std::size_t beyond = 0, occluded = 0;
  for (int i = 0; i < 12; ++i) {
    auto r =
        request(over(0.3 + 0.03 * i, 0.4, 60 + 90 * i), {Degrees{31.0 * i}, Degrees{-6}, Degrees{5.0 * i}});
    r.levers.drawn.occlusion = OcclusionResolution{400, 300};
    const double farM = 6000 + 1500 * i;
    r.decision.weather = fog(farM, farM);
    r.levers.drawn.farM = r.decision.weather.farM;
    r.cullingCase = CullingCase::none;
    FrameResult all, none;
    const Pixels8 whole = picture(r, &none);
    for (const CullingCase method : {CullingCase::view_frustum, CullingCase::proposed}) {
      r.cullingCase = method;
      EXPECT_EQ(differing(whole, picture(r, &all)), 0u) << i;
      beyond += all.visible.beyondVisibility;
      occluded += all.visible.occluded;
    }
    EXPECT_EQ(none.visible.beyondVisibility, 0u);
  }
  EXPECT_GT(beyond, 100u);
  EXPECT_GT(occluded, 5u);
}

// Two pictures of one place, clear and in weather: the same ridgeline wherever it can be seen.
TEST_F(Weather, showsTheSameRidgeAsClearAirUpToTheCutAndNothingBeyond) {
  use(test::syntheticMountains());
  for (const double farM : {800.0, 2500.0, 6000.0, 14e3, 30e3}) {
    auto r = level(350, 200);
    picture(r);
    const auto clear = renderer.readDistances();
    r.decision.weather = fog(farM, farM);
    r.levers.drawn.farM = r.decision.weather.farM;
    FrameResult result;
    const Pixels8 shown = picture(r, &result);
    const auto cut = renderer.readDistances();
    std::size_t kept = 0, gone = 0, wrong = 0;
    int edge = 0;
    for (std::size_t i = 0; i < clear.size(); ++i) {
      const double d = double{clear[i]};
      if (d < farM * 0.9999) {
        wrong += cut[i] != clear[i];
        ++kept;
      } else if (d > farM * 1.0001) {
        wrong += std::isfinite(cut[i]);
        gone += std::isfinite(d);
        // Where the ground stops for the cut's sake, nothing marks the place.
        if (i >= kWidth && std::isfinite(cut[i - kWidth]) && double{cut[i - kWidth]} > 0.97 * farM)
          edge = std::max(edge, largestStep(shown, i, i - kWidth));
      }
    }
    EXPECT_EQ(wrong, 0u) << farM;
    EXPECT_GT(kept, 0u);
    EXPECT_LE(edge, 2) << farM;
    if (farM > 20e3) continue;
    EXPECT_GT(gone, 300u);
    EXPECT_GT(result.visible.beyondVisibility, 0u);
  }
}

TEST_F(Weather, hasNoLineAtTheHorizonAtAnyVisibility) {
  use(std::make_shared<const test::SyntheticTerrain>(
      16, 1.0 / 300, GeodeticPosition{Degrees{10}, Degrees{20}, Metres{0}}, [](int, int) { return 0.0; }));
  for (const double above : {30.0, 1000.0, 3000.0})
    for (const double visibility : {50.0, 400.0, 3000.0, 10e3, 30e3, 100e3}) {
      // Ground that ends at the earth's horizon while it can still be seen does end in a line.
      if (visibility > 0.7 * std::sqrt(2 * 6371e3 * above)) continue;
      auto r = level(above, 0, 0);
      r.decision.weather = fog(visibility, visibility);
      r.levers.drawn.farM = r.decision.weather.farM;
      const Pixels8 shown = picture(r);
      const auto metres = renderer.readDistances();
      int sky = 0;
      double edge = 0;
      for (std::size_t i = kWidth; i < metres.size(); ++i) {
        if (!std::isinf(metres[i])) continue;
        const double below = double{metres[i - kWidth]};
        const int step = largestStep(shown, i, i - kWidth);
        if (std::isinf(below))
          sky = std::max(sky, step);
        else  // no more than what the fog leaves of the last ground
          edge = std::max(edge, step - 150 * std::exp(-r.decision.weather.extinctionPerM * below));
      }
      EXPECT_LE(sky, 2) << visibility << " m from " << above << " m";
      EXPECT_LE(edge, 1) << visibility << " m from " << above << " m";
    }
}

TEST_F(Weather, changesNoPixelByMoreThanItsThreshold) {
  use(test::syntheticMountains());
  auto r = level(120);
  const auto error = [&](double visibility, double farM) {
    r.decision.weather = fog(visibility, farM);
    r.levers.drawn.farM = r.decision.weather.farM;
    return scene::cutError(renderer, r, offscreen->framebuffer());
  };
  for (const double visibility : {1000.0, 5000.0, 15e3}) {
    const auto exact = error(visibility, visibility), wide = error(visibility, 2 * visibility),
               narrow = error(visibility, 0.3 * visibility);
    std::printf(
        "visibility %.0f m: cut there changes %zu of %zu by at most %d, twice as far %zu by %d, at 0.3 %zu "
        "by %d\n",
        visibility, exact.changed, exact.pixels, exact.largest, wide.changed, wide.largest, narrow.changed,
        narrow.largest);
    EXPECT_EQ(exact.pixels, std::size_t{kWidth} * kHeight);
    EXPECT_LE(exact.largest, 255 * kThreshold);
    EXPECT_LE(wide.largest, 1);
    EXPECT_LE(wide.changed * 50, wide.pixels);
    EXPECT_GT(narrow.largest, 10) << "a cut before the visibility must be seen";
  }
  EXPECT_EQ(error(5000, kInfinity).changed, 0u);
}

TEST_F(Weather, isDefinedAtVisibilitiesThatAreNone) {
  use(test::syntheticMountains());
  auto r = level(300);
  const Pixels8 clear = picture(r);
  r.decision.weather = fog(0, 0);
  r.levers.drawn.farM = r.decision.weather.farM;
  const Pixels8 nothing = picture(r);
  for (std::size_t i = 1; i < nothing.size() / 4; ++i) ASSERT_LE(largestStep(nothing, 0, i), 1);
  r.decision.weather = fog(kNan, kNan);
  r.levers.drawn.farM = r.decision.weather.farM;
  EXPECT_EQ(differing(clear, picture(r)), 0u);
  r.decision.weather = fog(kInfinity);
  r.levers.drawn.farM = r.decision.weather.farM;
  EXPECT_EQ(differing(clear, picture(r)), 0u);
}

TEST_F(Weather, showsWhatItCullsByAColourOfItsOwn) {
  use(test::syntheticMountains());
  auto r = level(500);
  r.decision.weather = fog(4000, 4000);
  r.levers.drawn.farM = r.decision.weather.farM;
  r.overlays.colourByReason = true;
  FrameResult result;
  const Pixels8 shown = picture(r, &result);
  ASSERT_GT(result.visible.beyondVisibility, 0u);
  const auto colour = reasonColour(CullReason::beyond_visibility);
  EXPECT_GT(int{colour[2]}, int{colour[0]}) << "blue";
  const auto metres = renderer.readDistances();
  std::size_t blue = 0, far = 0;
  for (std::size_t i = 0; i < metres.size(); ++i) {
    if (!(metres[i] > 10e3f) || std::isinf(metres[i])) continue;
    ++far;
    blue += shown[4 * i + 2] > shown[4 * i] + 20;
  }
  ASSERT_GT(far, 1000u) << "fog and cut are off: it is to be seen";
  EXPECT_GT(blue * 10, far * 9);
}

}  // namespace
}  // namespace trimtab
