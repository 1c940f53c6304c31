#include "trimtab/weather/haze_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trimtab/decision/decide.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/weather/weather.h"

namespace trimtab::test {
namespace {

constexpr double kRadius = kEarthRadiusM;

/// The height of the point at distance `t` along a ray.
double heightAt(double eyeM, double rise, double t) {
  const double cosine = std::sqrt(1 - rise * rise);
  return std::hypot(kRadius + eyeM + rise * t, cosine * t) - kRadius;
}

/// The same length by small steps.
double summedLength(double eyeM, double rise, double lengthM, double topM) {
  constexpr int kSteps = 20'000;
  int inside = 0;
  for (int i = 0; i < kSteps; ++i) inside += heightAt(eyeM, rise, (i + 0.5) / kSteps * lengthM) <= topM;
  return lengthM * inside / kSteps;
}

TEST(HazeLayer, isAsLongAlongARayAsSmallStepsFindIt) {
  std::mt19937 random(4);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int partly = 0;
  for (int i = 0; i < 400; ++i) {
    const double eye = between(0, 6000), top = between(0, 4000), length = std::exp(between(3, 13));
    const double rise = i % 4 == 0 ? between(-1, 1) : i % 4 == 1 ? 0 : between(-0.05, 0.05);
    const double summed = summedLength(eye, rise, length, top);
    EXPECT_NEAR(lengthInLayer(eye, rise, length, top), summed, length * 2e-4 + 0.5)
        << eye << " m, rise " << rise << ", " << length << " m, top " << top;
    partly += summed > 0 && summed < length;
  }
  EXPECT_GT(partly, 50);
}

TEST(HazeLayer, neitherJumpsAtALevelRayNorAtTheTop) {
  for (const double top : {200.0, 2000.0})
    for (const double eye : {0.0, 199.999, 200.0, 200.001, 1999.0, 2000.0, 2001.0})
      for (const double length : {100.0, 40e3, kInfinity}) {
        const double level = lengthInLayer(eye, 0, length, top);
        ASSERT_TRUE(std::isfinite(level) && level >= 0 && level <= length);
        for (const double rise : {-1e-9, 1e-9})
          EXPECT_NEAR(lengthInLayer(eye, rise, length, top), level, 1) << eye << ' ' << top << ' ' << length;
        EXPECT_NEAR(lengthInLayer(eye, 0.1, length, top), lengthInLayer(eye + 1e-6, 0.1, length, top), 1e-3);
      }
}

TEST(HazeLayer, hidesAtTheSafeDistanceWhateverTheRay) {
  std::mt19937 random(9);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int finite = 0, aboveTheLayer = 0;
  double most = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double visibility = std::exp(between(std::log(50), std::log(100e3)));
    const double top = between(-400, 6000), eye = between(-400, 12e3), highest = between(-400, 9000);
    const double sigma = extinction(visibility, kOpticalRangeContrast);
    const double far = safeFarM(sigma, top, eye, highest);
    if (std::isinf(far)) continue;
    ++finite;
    aboveTheLayer += eye > top;
    // Ground of any height at that distance, or farther. The eye is as high as it may have climbed since.
    const double climbed = eye + between(-100, 100), distance = far * between(1, 3);
    const double ground = between(-400, highest);
    const double chord = (ground - climbed) * (2 * kRadius + ground + climbed) - distance * distance;
    const double rise = chord / (2 * (kRadius + climbed) * distance);
    if (std::abs(rise) > 1) continue;
    const double left = std::exp(-sigma * lengthInLayer(climbed, rise, distance, top));
    const double behind = std::exp(-sigma * lengthInLayer(climbed, rise, kInfinity, top));
    ASSERT_LE(left, 1 / 255.0) << visibility << " m, top " << top << ", eye " << climbed << ", ground "
                               << ground << " at " << distance;
    ASSERT_LE(behind, left);
    most = std::max(most, left);
  }
  EXPECT_GT(finite, 50'000);
  EXPECT_GT(aboveTheLayer, 5'000);
  EXPECT_GT(most, 0.9 / 255) << "it is no farther than it has to be";
}

TEST(SafeFarDistance, isDefinedForEveryInput) {
  const double one = extinction(1000, kOpticalRangeContrast);
  struct Case {
    const char* what;
    double extinction, top, eye, highest, far;
  };
  const double inside = std::log(256.0) / one;
  for (const Case& c : {
           Case{"in the layer, as all ground", one, 3000, 100, 2000, inside},
           Case{"a layer without a top", one, kInfinity, 100, 9000, inside},
           Case{"visibility 0", kInfinity, 3000, 100, 2000, 0},
           Case{"no haze", 0, 3000, 100, 2000, kInfinity},
           Case{"negative extinction", -1, 3000, 100, 2000, kInfinity},
           Case{"huge visibility", 1e-30, 3000, 100, 2000, kInfinity},
           Case{"extinction that is no number", kNan, 3000, 100, 2000, kInfinity},
           Case{"top that is no number", one, kNan, 100, 2000, kInfinity},
           Case{"eye that is no number", one, 3000, kNan, 2000, kInfinity},
           Case{"ground that is no number", one, 3000, 100, kNan, kInfinity},
           Case{"eye infinitely high", one, 3000, kInfinity, 2000, kInfinity},
           Case{"eye infinitely low", one, 3000, -kInfinity, 2000, inside},
           Case{"ground infinitely high", one, 3000, 100, kInfinity, kInfinity},
           Case{"no layer", one, -kInfinity, 100, 2000, kInfinity},
           Case{"eye above the layer, ground too", one, 3000, 5000, 4000, kInfinity},
           Case{"eye above the layer, ground below it", one, 2000, 3900, 900, inside * 3},
           Case{"eye in the layer, ground above it", one, 2000, 900, 3900, inside * 3},
       })
    EXPECT_DOUBLE_EQ(safeFarM(c.extinction, c.top, c.eye, c.highest), c.far) << c.what;
}

TuningParameters inHaze(double visibilityM, double topM) {
  TuningParameters p;
  p.weather.air = AirModel::layer;
  p.weather.layerTop = Metres{topM};
  p.weather.visibilityFrom = VisibilitySource::typed;
  p.weather.typedVisibility = Metres{visibilityM};
  return p;
}

AircraftState at(double heightM) {
  AircraftState state;
  state.position.height = Metres{heightM};
  return state;
}

TEST(HazeLayer, hasTheExtinctionOfTheOpticalRangeAndCutsAtTheSafeDistance) {
  const TuningParameters p = inHaze(5000, 3000);
  const WeatherDecision d = decideWeather(at(500), p, Metres{1800});
  EXPECT_NEAR(d.extinctionPerM * 5000, 2.9957, 1e-4) << "whatever the contrast threshold of document D";
  EXPECT_EQ(d.layerTopM, 3000);
  EXPECT_EQ(d.farReason, FarReason::safe);
  EXPECT_EQ(d.farM, d.safeFarM);
  EXPECT_EQ(d.safeFarM, safeFarM(d.extinctionPerM, 3000, 500, 1800));
  EXPECT_DOUBLE_EQ(d.nearFarRatio, 1 / d.farM);
  EXPECT_GT(decideWeather(at(500), p).farM, d.farM) << "without a terrain ground may stand above the haze";
  DecisionMemory memory;
  FrameInput input{at(500), {}, {}, {}, {}, Metres{1800}};
  EXPECT_EQ(decide(input, validate(p).value(), memory).weather, d);
}

TEST(HazeLayer, isNotCutWhereSomethingMayBeSeenAtAnyDistance) {
  const WeatherDecision d = decideWeather(at(5000), inHaze(500, 1000), Metres{1800});
  EXPECT_EQ(d.farReason, FarReason::unbounded);
  EXPECT_EQ(d.farM, WeatherDecision::kUnlimited);
  EXPECT_EQ(d.nearFarRatio, 0);
  EXPECT_TRUE(d.fogged);
  EXPECT_NE(explain(d).find("any distance"), std::string::npos);
}

TEST(HazeLayer, mayBeCutFartherByCalibrationAndElseByTheRatioThatIsFixed) {
  TuningParameters p = inHaze(5000, 3000);
  p.weather.step = WeatherStep::rain_light;
  p.rainLight.farStretch = Ratio{8};
  WeatherDecision d = decideWeather(at(500), p, Metres{1800});
  EXPECT_EQ(d.farM, 40e3);
  EXPECT_EQ(d.farReason, FarReason::stretched);
  p.rainLight.farStretch = Ratio{1.2};
  d = decideWeather(at(500), p, Metres{1800});
  EXPECT_EQ(d.farM, d.safeFarM) << "never nearer than what may be seen";
  p.weather.ratioMode = RatioMode::fixed;
  d = decideWeather(at(500), p, Metres{1800});
  EXPECT_NEAR(d.farM, 20e3, 1e-9);
  p.weather.ratioMode = RatioMode::off;
  EXPECT_EQ(decideWeather(at(500), p, Metres{1800}).farM, WeatherDecision::kUnlimited);
}

TEST(HazeLayer, isNoneInClearWeather) {
  TuningParameters p;
  p.weather.air = AirModel::layer;
  EXPECT_EQ(decideWeather(at(500), p), WeatherDecision{});
}

}  // namespace
}  // namespace trimtab::test
