#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "quad.h"
#include "table.h"
#include "trimtab/weather/calibrate.h"
#include "trimtab/weather/weather.h"

namespace trimtab::stress {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double between(double low, double high) { return low * std::pow(high / low, unit()); }

 private:
  std::mt19937_64 random_;
};

TEST(WeatherStress, extinctionLeavesTheThresholdAtTheVisibility) {
  Dice dice(51);
  Case law("weather", "extinction for visibilities of 10 m to 1,000 km, relative", 3 * kU, "",
           "a logarithm good to two roundings, and the quotient");
  Case left("weather", "contrast left at the visibility, relative", (4 * 6.91 + 1) * kU, "",
            "the exponent, at most ln 1000 = 6.91, is off by four roundings");
  Case far("weather", "extinction at unlimited and unheard-of visibilities", 0, "violations",
           "0 where unlimited, never NaN, never below 0");
  for (std::size_t i = 0; i < samples(300000); ++i) {
    const double visibility = i % 5 == 0 ? dice.between(1e-3, 1e15) : dice.between(10, 1e6),
                 threshold = dice.between(0.001, 0.5);
    const double ours = extinction(visibility, threshold);
    law.see(relative(ours, -logq(threshold) / visibility),
            [&] { return digits(visibility) + " at " + digits(threshold); });
    left.see(relative(threshold, expq(-Quad{ours} * visibility)));
  }
  for (const double visibility : {5e-324, 1e-300, 1e300, 1.7e308, HUGE_VAL})
    for (const double threshold : {0.001, 0.02, 0.5})
      far.require(extinction(visibility, threshold) >= 0 &&
                  (!std::isinf(visibility) || extinction(visibility, threshold) == 0));
}

TEST(WeatherStress, equationOnePutsTheFarPlaneAtTheVisibility) {
  Dice dice(52);
  Case adaptive("weather", "Eq. (1): far plane against visibility x stretch, relative", 3 * kU, "",
                "a product and two quotients");
  Case fixed("weather", "fixed ratio: far plane", 0, "m", "the quotient of near and ratio, rounded once");
  Case off("weather", "no cut without fog or with the mode off", 0, "violations", "weather.h: unlimited");
  for (std::size_t i = 0; i < samples(300000); ++i) {
    WeatherParameters p;
    p.defaultNear = Metres{dice.between(0.001, 1000)};
    p.fixedRatio = Ratio{dice.between(1e-7, 0.1)};
    WeatherDecision d;
    d.visibilityM = dice.between(10, 1e6), d.extinctionPerM = extinction(d.visibilityM, 0.02),
    d.fogged = true;
    const double stretch = dice.unit() < 0.3 ? 1 : dice.between(1, 1e5);
    setFarPlane(d, p, stretch);
    adaptive.see(relative(d.farM, Quad{d.visibilityM} * stretch));
    p.ratioMode = RatioMode::fixed;
    setFarPlane(d, p, stretch);
    fixed.see(distance(d.farM, toDouble(Quad{p.defaultNear.value()} / p.fixedRatio.value())));
    p.ratioMode = RatioMode::off;
    setFarPlane(d, p, stretch);
    off.require(std::isinf(d.farM) && d.nearFarRatio == 0);
    p.ratioMode = RatioMode::adaptive, d.fogged = false;
    setFarPlane(d, p, stretch);
    off.require(std::isinf(d.farM) && d.nearFarRatio == 0);
  }
}

TEST(WeatherStress, anyHostsWeatherIsDrawable) {
  Dice dice(53);
  Case bounded("weather", "a million weathers of a host: all that is decided can be drawn", 0, "violations",
               "visibility 10 m to 1,000 km or unlimited, density 0..1, far plane not before the visibility");
  Case pure("weather", "the same weather decided again", 0, "differences", "pure: no state to drift");
  TuningParameters p;
  p.weather.source = WeatherSource::host;
  const double odd[] = {0, -1, -HUGE_VAL, HUGE_VAL, std::nan(""), 5e-324, 1e-3, 9.99, 1e6 + 1, 1e300};
  const auto visibility = [&] {
    return Metres{dice.unit() < 0.4 ? odd[static_cast<std::size_t>(dice.unit() * 9.99)]
                                    : dice.between(1, 1e7)};
  };
  AircraftState first;
  WeatherDecision firstDecision;
  for (std::size_t i = 0; i < samples(1000000, 20000000); ++i) {
    p.weather.haze = i % 3 == 0;
    p.rainMedium.farStretch = Ratio{i % 7 == 0 ? 1e5 : 1.0};
    AircraftState s;
    if (dice.unit() < 0.8) s.visibility = visibility();
    if (dice.unit() < 0.8) {
      s.weather = HostWeather{static_cast<Precipitation>(static_cast<int>(dice.unit() * 2.99)),
                              static_cast<int>(dice.unit() * 9) - 2, std::nullopt};
      if (dice.unit() < 0.7) s.weather->visibility = visibility();
    }
    const WeatherDecision d = decideWeather(s, p);
    const bool drawable = d.visibilityM >= 10 && (d.visibilityM <= 1e6 || std::isinf(d.visibilityM));
    bounded.require(drawable && d.density >= 0 && d.density <= 1 && std::isfinite(d.extinctionPerM) &&
                    d.extinctionPerM >= 0 && (d.precipitation != Precipitation::none) == (d.density > 0) &&
                    (std::isinf(d.farM) || d.farM >= d.visibilityM * (1 - 3 * kU)));
    if (i == 0) first = s, firstDecision = d;
  }
  p.weather.haze = true;
  p.rainMedium.farStretch = Ratio{1e5};
  pure.require(decideWeather(first, p) == firstDecision);
}

TEST(WeatherStress, theFarPlaneIsFoundAtAnyVisibility) {
  Dice dice(54);
  Case found("weather", "far-plane search: frames farther from clear weather than the tolerance", 0, "runs",
             "the calibration's promise of a match");
  Case where("weather", "far-plane search: plane between visibility and terrain", 0, "violations",
             "nothing is cut nearer than one sees, nothing lies beyond the terrain");
  Case halves("weather", "far-plane search: outcomes other than a match", 0, "runs",
              "costs that rise with the plane's square reach the clear frame's in between: twelve halvings "
              "of a logarithm find it");
  for (std::size_t i = 0; i < samples(2000); ++i) {
    TuningParameters p;
    p.weather.visibilityFrom = VisibilitySource::typed;
    const double visibility = dice.between(10, 5e4), farthest = 200e3, base = dice.between(0.1, 100);
    p.weather.typedVisibility = Metres{visibility};
    p.weather.defaultNear = Metres{dice.between(0.001, 1000)};
    // A frame costs a base and the ground it shows; weather costs as much as a plane at `matching` saves.
    const double matching =
        std::exp(std::log(visibility) + (0.05 + 0.9 * dice.unit()) * std::log(farthest / visibility));
    const double ground = base * dice.between(0.2, 5);
    const auto shown = [&](double farM) {
      return ground * std::pow(std::min(farM, farthest) / farthest, 0.7);
    };
    const double weather = ground - shown(matching);
    const MeasureFrame measure = [&](const WeatherDecision& d) -> std::optional<double> {
      return base + shown(d.farM) + (d.precipitation == Precipitation::none ? 0 : weather);
    };
    const auto result = calibrateStep(WeatherStep::rain_heavy, p, measure, {});
    ASSERT_TRUE(result);
    const double clear = base + ground;
    if (result->outcome == CalibrationOutcome::costs_nothing) continue;
    halves.require(result->outcome == CalibrationOutcome::matched,
                   [&] { return std::string(toText(result->outcome)) + " at " + digits(visibility); });
    found.require(std::abs(result->matchedMs - clear) <= 0.05 * clear);
    where.require(result->farM >= visibility * (1 - 3 * kU) && result->farM <= farthest &&
                  std::isfinite(result->nearFarRatio));
  }
}

}  // namespace
}  // namespace trimtab::stress
