#include <cmath>
#include <limits>
#include <random>

#include "core/scene/passes/weather_air.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/weather/haze_layer.h"
#include "trimtab/weather/weather.h"

/// Pictures in a layer of haze, and the promise of the safe far distance.
namespace trimtab {
namespace {

using test::SceneTest;
using Pixels8 = std::vector<std::uint8_t>;

WeatherDecision hazeAt(Metres height, double visibilityM, double topM, std::optional<Metres> highest,
                       RatioMode mode = RatioMode::adaptive) {
  TuningParameters p;
  p.weather.air = AirModel::layer;
  p.weather.layerTop = Metres{topM};
  p.weather.ratioMode = mode;
  p.weather.visibilityFrom = VisibilitySource::typed;
  p.weather.typedVisibility = Metres{visibilityM};
  AircraftState state;
  state.position.height = height;
  return decideWeather(state, p, highest);
}

class HazeLayerPicture : public SceneTest {
 protected:
  static constexpr double kPitch = -4;

  /// A level view but for its pitch.
  FrameRequest level(double aboveM, double pitch = kPitch) const {
    auto r = request(over(0.5, 0.5, aboveM), {Degrees{30}, Degrees{pitch}, Degrees{0}});
    r.cullingCase = CullingCase::view_frustum;
    return r;
  }
  /// The sine of the elevation at which a pixel of such a view looks.
  static double riseOf(const FrameRequest& r, std::size_t pixel) {
    const double x = static_cast<double>(pixel % kWidth) + 0.5, y = static_cast<double>(pixel / kWidth) + 0.5;
    const double u = r.view.left + (r.view.right - r.view.left) * x / kWidth,
                 v = r.view.bottom + (r.view.top - r.view.bottom) * y / kHeight;
    const double pitch = r.attitude.pitch.value() * M_PI / 180;
    return (v * std::cos(pitch) + std::sin(pitch)) / std::sqrt(1 + u * u + v * v);
  }
  /// The share of its own colour that ground and sky have at a pixel; infinite metres are sky.
  static double leftOf(const FrameRequest& r, std::size_t pixel, double metres) {
    const WeatherDecision& w = r.decision.weather;
    return std::exp(-w.extinctionPerM *
                    lengthInLayer(r.eye.height.value(), riseOf(r, pixel), metres, w.layerTopM));
  }
  FrameRequest anyView(std::mt19937& random) const {
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double above = std::exp(between(std::log(30), std::log(6000)));
    auto r = request(over(between(0.1, 0.9), between(0.1, 0.9), above),
                     {Degrees{between(0, 360)}, Degrees{between(-40, 30)}, Degrees{between(-60, 60)}});
    r.cullingCase = CullingCase::view_frustum;
    r.terrain.form = random() % 2 == 0 ? TerrainForm::tiles : TerrainForm::patches;
    // Tops about the terrain's own heights, and high above them.
    const double highest = database->info().highest.value();
    const double top = random() % 3 == 0 ? between(0, highest) : between(highest, 3 * highest + 3000);
    const double visibility = std::exp(between(std::log(50), std::log(100e3)));
    r.decision.weather = hazeAt(r.eye.height, visibility, top, database->highest());
    r.levers.drawn.farM = r.decision.weather.farM;
    return r;
  }

  struct Seen {
    int views = 0, cut = 0, changed = 0, largest = 0;
  };
  void seeCuts(int views, unsigned seed, Seen& seen) {
    std::mt19937 random(seed);
    for (int i = 0; i < views; ++i) {
      const FrameRequest r = anyView(random);
      FrameResult result;
      ++seen.views;
      if (std::isinf(r.levers.drawn.farM)) continue;
      const auto error = scene::cutError(renderer, r, offscreen->framebuffer());
      picture(r, &result);
      seen.cut += result.visible.beyondVisibility > 0;
      seen.changed += error.changed > 0;
      seen.largest = std::max(seen.largest, error.largest);
      EXPECT_LE(error.largest, 1) << "view " << i << ", " << explain(r.decision.weather) << ", eye at "
                                  << r.eye.height.value() << " m";
    }
  }
};

TEST(Air, fadesBeforeACutOfTheLayerOnlyWhereSomethingIsLeftToFade) {
  WeatherDecision w = hazeAt(Metres{500}, 5000, 3000, Metres{1800});
  ASSERT_EQ(w.farReason, FarReason::safe);
  EXPECT_GE(scene::airOf(w, w.farM).fadePerM * w.farM, 1e6) << "what fades could be seen";
  w.farM *= 0.5;  // as a policy may
  EXPECT_NEAR(double{scene::airOf(w, w.farM).fadePerM} * w.farM * scene::kCutFade, 1, 1e-6)
      << "an edge could be seen";
}

TEST_F(HazeLayerPicture, isTheOpticalDepthAtEveryPixelOfTheGround) {
  use(test::syntheticMountains());
  std::size_t partly = 0;
  for (const double above : {60.0, 2500.0}) {
    auto r = level(above);
    const Pixels8 clear = picture(r);
    const auto metres = renderer.readDistances();
    for (const double visibility : {300.0, 3000.0, 40e3})
      for (const double top : {r.eye.height.value() - 800, r.eye.height.value() + 20, 6000.0}) {
        r.decision.weather = hazeAt(r.eye.height, visibility, top, {}, RatioMode::off);
        r.levers.drawn.farM = r.decision.weather.farM;
        const auto fog = scene::airOf(r.decision.weather, r.levers.drawn.farM).colour;
        const Pixels8 shown = picture(r);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < metres.size(); ++i) {
          if (std::isinf(metres[i])) continue;
          const double left = leftOf(r, i, double{metres[i]});
          partly += left > 0.05 && left < 0.95;
          for (std::size_t c = 0; c < 3; ++c) {
            const double level = 255 * double{fog[c]};
            wrong += std::abs(level + (double(clear[4 * i + c]) - level) * left - shown[4 * i + c]) > 1.5;
          }
        }
        EXPECT_EQ(wrong, 0u) << visibility << " m up to " << top << " m from " << r.eye.height.value();
      }
  }
  EXPECT_GT(partly, 100'000u);
}

TEST_F(HazeLayerPicture, endsInTheSkyWhereTheLayerEnds) {
  use(test::syntheticMountains());
  auto r = level(900, 20);
  const Pixels8 clear = picture(r);
  const auto metres = renderer.readDistances();
  for (const double visibility : {2000.0, 20e3})
    for (const double top : {r.eye.height.value() - 100, r.eye.height.value() + 500}) {
      r.decision.weather = hazeAt(r.eye.height, visibility, top, {}, RatioMode::off);
      r.levers.drawn.farM = r.decision.weather.farM;
      const auto fog = scene::airOf(r.decision.weather, r.levers.drawn.farM).colour;
      const Pixels8 shown = picture(r);
      for (std::size_t i = 0; i < metres.size(); ++i) {
        if (std::isfinite(metres[i]) || riseOf(r, i) < 0.01) continue;
        const double left = leftOf(r, i, 1e9);
        for (std::size_t c = 0; c < 3; ++c) {
          const double level = 255 * double{fog[c]};
          ASSERT_NEAR(level + (double(clear[4 * i + c]) - level) * left, shown[4 * i + c], 1.5)
              << visibility << " m up to " << top << ": " << i % kWidth << ", " << i / kWidth;
        }
      }
    }
}

TEST_F(HazeLayerPicture, hasNoSeamBetweenFoggedGroundAndTheSky) {
  use(std::make_shared<const test::SyntheticTerrain>(
      16, 1.0 / 300, GeodeticPosition{Degrees{10}, Degrees{20}, Metres{0}}, [](int, int) { return 0.0; }));
  for (const double above : {30.0, 1000.0, 4000.0})
    for (const double top : {300.0, 6000.0})
      for (const double visibility : {50.0, 3000.0, 10e3, 30e3, 100e3}) {
        auto r = level(above, 0);
        r.decision.weather = hazeAt(r.eye.height, visibility, top, database->highest());
        r.levers.drawn.farM = r.decision.weather.farM;
        const Pixels8 shown = picture(r);
        const auto metres = renderer.readDistances();
        int sky = 0;
        double edge = 0;
        for (std::size_t i = kWidth; i < metres.size(); ++i) {
          if (!std::isinf(metres[i])) continue;
          const double below = double{metres[i - kWidth]};
          const int step = largestStep(shown, i, i - kWidth);
          // Above a thin layer its own top is an edge in the sky, as it is outside.
          if (std::isinf(below) && top > above)
            sky = std::max(sky, step);
          else if (!std::isinf(below))  // no more than what the haze leaves of the last ground
            edge = std::max(edge, step - 150 * leftOf(r, i - kWidth, below));
        }
        EXPECT_LE(sky, 2) << visibility << " m up to " << top << " from " << above << " m";
        EXPECT_LE(edge, 2) << visibility << " m up to " << top << " from " << above << " m";
      }
}

TEST_F(HazeLayerPicture, isTheSameInAllThreeCullingCases) {
  use(test::syntheticMountains());
  std::mt19937 random(3);
  std::size_t beyond = 0;
  for (int i = 0; i < 5; ++i) {
    auto r = anyView(random);
    r.levers.drawn.occlusion = OcclusionResolution{400, 300};
    r.cullingCase = CullingCase::none;
    const Pixels8 whole = picture(r);
    for (const CullingCase method : {CullingCase::view_frustum, CullingCase::proposed}) {
      FrameResult result;
      r.cullingCase = method;
      EXPECT_EQ(differing(whole, picture(r, &result)), 0u) << i;
      beyond += result.visible.beyondVisibility;
    }
  }
  EXPECT_GT(beyond, 50u);
}

// TRIMTAB_SOAK=10 sees 500 views, over real terrain as well.
TEST_F(HazeLayerPicture, changesNoChannelByMoreThanALevelWhereItIsCutAtTheSafeDistance) {
  Seen seen;
  const int times = test::soak();
  use(test::patchedMountains(true));
  seeCuts(times > 1 ? 25 * times : 20, 11, seen);
  if (times > 1) {
    ASSERT_TRUE(useSample());
    seeCuts(10 * times, 12, seen);
    for (const char* folder : {"fg-kansai-e135n35", "dem-srtm3-everest", "fg-debian-hawaii-bigisland"})
      if (useShared(folder)) seeCuts(5 * times, 13, seen);
  }
  std::printf("%d views: tiles are cut in %d, %d images change, by at most %d\n", seen.views, seen.cut,
              seen.changed, seen.largest);
  EXPECT_GT(seen.cut * 3, seen.views);
  EXPECT_GT(seen.changed, 0);
}

TEST_F(HazeLayerPicture, isDefinedForLayersThatAreNone) {
  use(test::syntheticMountains());
  auto r = level(300);
  const Pixels8 clear = picture(r);
  WeatherDecision w = hazeAt(r.eye.height, 1000, 3000, {});
  w.extinctionPerM = std::numeric_limits<double>::infinity();
  w.safeFarM = w.farM = 0;
  r.decision.weather = w;
  r.levers.drawn.farM = r.decision.weather.farM;
  const Pixels8 nothing = picture(r);
  for (std::size_t i = 1; i < nothing.size() / 4; ++i) ASSERT_LE(largestStep(nothing, 0, i), 1);
  // No ray of the view meets a layer far below the ground.
  r.decision.weather = hazeAt(r.eye.height, 1000, -100e3, {});
  r.levers.drawn.farM = r.decision.weather.farM;
  EXPECT_EQ(r.decision.weather.farReason, FarReason::unbounded);
  picture(r);
  r.decision.weather = hazeAt(r.eye.height, std::numeric_limits<double>::infinity(), 3000, {});
  r.levers.drawn.farM = r.decision.weather.farM;
  EXPECT_EQ(differing(clear, picture(r)), 0u);
}

}  // namespace
}  // namespace trimtab
