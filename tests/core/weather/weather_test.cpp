#include "trimtab/weather/weather.h"

#include <cmath>

#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::test {
namespace {

TuningParameters inStep(WeatherStep step) {
  TuningParameters p;
  p.weather.step = step;
  return p;
}

TuningParameters byHost() {
  TuningParameters p;
  p.weather.source = WeatherSource::host;
  return p;
}

AircraftState saying(std::optional<HostWeather> weather, std::optional<Metres> visibility = {}) {
  AircraftState state;
  state.weather = weather;
  state.visibility = visibility;
  return state;
}

TEST(Weather, ofTheDefaultPresetIsClearWithNothingCut) {
  EXPECT_EQ(decideWeather(AircraftState{}, *defaultParameters()), WeatherDecision{});
  AircraftState hostSpeaks = saying(HostWeather{Precipitation::snow, 5, {}}, Metres{300});
  EXPECT_EQ(decideWeather(hostSpeaks, *defaultParameters()), WeatherDecision{});
  DecisionMemory memory;
  EXPECT_EQ(decide({hostSpeaks, {}, {}, {}, {}}, defaultParameters(), memory).weather, WeatherDecision{});
}

TEST(Weather, isDecidedThoughTheAircraftIsNowhere) {
  AircraftState state;
  state.attitude.pitch = Degrees{kNan};
  DecisionMemory memory;
  const ValidatedParameters parameters = validate(inStep(WeatherStep::rain_heavy)).value();
  EXPECT_EQ(decide({state, {}, {}, {}, {}}, parameters, memory).weather.precipitation, Precipitation::rain);
}

TEST(Weather, leavesTheContrastThresholdAtTheVisibility) {
  for (const double threshold : {0.02, 0.05, 0.5})
    for (const double visibility : {10.0, 1500.0, 1e6})
      EXPECT_NEAR(std::exp(-extinction(visibility, threshold) * visibility), threshold, 1e-12);
  EXPECT_NEAR(extinction(1000, 0.02) * 1000, 3.912, 5e-4) << "Koschmieder's constant";
  EXPECT_NEAR(extinction(1000, 0.05) * 1000, 2.996, 5e-4) << "that of the meteorological optical range";
  EXPECT_EQ(extinction(kInfinity, 0.02), 0);
}

struct StepCase {
  WeatherStep step;
  Precipitation falls;
  double visibilityM, density;
};

TEST(Weather, ofEachStepIsItsShareOfTheClearDay) {
  const StepCase cases[] = {{WeatherStep::rain_light, Precipitation::rain, 20000, 0.25},
                            {WeatherStep::rain_medium, Precipitation::rain, 10000, 0.5},
                            {WeatherStep::rain_heavy, Precipitation::rain, 4000, 1},
                            {WeatherStep::snow_light, Precipitation::snow, 10000, 0.25},
                            {WeatherStep::snow_medium, Precipitation::snow, 4000, 0.5},
                            {WeatherStep::snow_heavy, Precipitation::snow, 1600, 1}};
  for (const StepCase& c : cases) {
    for (const double scale : {1.0, 0.5}) {
      TuningParameters p = inStep(c.step);
      p.weather.clearVisibility = Metres{40000 * scale};
      p.weather.defaultNear = Metres{2};
      const WeatherDecision d = decideWeather(AircraftState{}, p);
      EXPECT_EQ(d.precipitation, c.falls);
      EXPECT_EQ(d.density, c.density);
      EXPECT_TRUE(d.fogged);
      EXPECT_NEAR(d.visibilityM, c.visibilityM * scale, 1e-9);
      EXPECT_NEAR(d.nearFarRatio, 2 / (c.visibilityM * scale), 1e-15) << "Eq. (1)";
      EXPECT_NEAR(d.farM, c.visibilityM * scale, 1e-9) << "the strongest cut that removes nothing visible";
      EXPECT_EQ(d.reason, WeatherReason::step);
      EXPECT_EQ(d.farReason, FarReason::visible);
    }
  }
}

TEST(Weather, takesTheTypedVisibilityInEveryStep) {
  for (const WeatherStep step : {WeatherStep::clear, WeatherStep::rain_light, WeatherStep::snow_heavy}) {
    TuningParameters p = inStep(step);
    p.weather.visibilityFrom = VisibilitySource::typed;
    p.weather.typedVisibility = Metres{1234};
    const WeatherDecision d = decideWeather(AircraftState{}, p);
    EXPECT_EQ(d.visibilityM, 1234);
    EXPECT_EQ(d.farM, 1234);
    EXPECT_EQ(d.reason, WeatherReason::typed);
    EXPECT_EQ(d.precipitation == Precipitation::none, step == WeatherStep::clear);
  }
}

TEST(Weather, refusesATypedVisibilityOutsideItsRange) {
  for (const double bad : {0.0, -5.0, 9.99, 1.01e6, kInfinity, kNan}) {
    TuningParameters p;
    p.weather.typedVisibility = Metres{bad};
    const auto result = validate(p);
    EXPECT_FALSE(result) << bad;
    ASSERT_FALSE(result.findings().empty());
    EXPECT_EQ(result.findings().front().key, "weather.typed_visibility_m");
  }
}

TEST(Weather, cutsByTheModeOfTheRatio) {
  TuningParameters p = inStep(WeatherStep::rain_medium);
  p.rainMedium.farStretch = Ratio{2.5};
  WeatherDecision d = decideWeather(AircraftState{}, p);
  EXPECT_NEAR(d.farM, 25000, 1e-9);
  EXPECT_NEAR(d.nearFarRatio, 4e-5, 1e-17);
  EXPECT_EQ(d.farReason, FarReason::stretched);

  p.weather.ratioMode = RatioMode::fixed;
  p.weather.fixedRatio = Ratio{1e-4};
  d = decideWeather(AircraftState{}, p);
  EXPECT_NEAR(d.farM, 10000, 1e-9);
  EXPECT_EQ(d.farReason, FarReason::fixed);
  p.weather.step = WeatherStep::snow_heavy;
  EXPECT_NEAR(decideWeather(AircraftState{}, p).farM, 10000, 1e-9) << "one ratio for all weather";
  p.weather.step = WeatherStep::clear;
  d = decideWeather(AircraftState{}, p);
  EXPECT_NEAR(d.farM, 10000, 1e-9) << "clear air too";
  EXPECT_EQ(d.farReason, FarReason::fixed);
  EXPECT_FALSE(d.fogged);
  p.weather.ratioMode = RatioMode::adaptive;
  d = decideWeather(AircraftState{}, p);
  EXPECT_EQ(d.farM, kInfinity) << "there is no visibility to cut at";
  EXPECT_EQ(d.farReason, FarReason::clear);

  p = inStep(WeatherStep::rain_medium);
  p.weather.ratioMode = RatioMode::off;
  d = decideWeather(AircraftState{}, p);
  EXPECT_EQ(d.farM, kInfinity);
  EXPECT_EQ(d.nearFarRatio, 0);
  EXPECT_TRUE(d.fogged);
}

TEST(Weather, hazesAClearDayOnlyWhenAsked) {
  TuningParameters p;
  p.weather.haze = true;
  const WeatherDecision d = decideWeather(AircraftState{}, p);
  EXPECT_TRUE(d.fogged);
  EXPECT_EQ(d.visibilityM, 40000);
  EXPECT_EQ(d.farM, 40000);
  EXPECT_EQ(d.reason, WeatherReason::haze);
}

TEST(Weather, withoutParticlesIsFogAlone) {
  TuningParameters p = inStep(WeatherStep::rain_heavy);
  p.rainHeavy.density = Ratio{0};
  const WeatherDecision d = decideWeather(AircraftState{}, p);
  EXPECT_EQ(d.precipitation, Precipitation::none);
  EXPECT_TRUE(d.fogged);
}

TEST(HostWeather, isDrawnAsTheHostSays) {
  const TuningParameters p = byHost();
  // Density by the severity's curve; visibility the nearer of atmosphere and layer.
  WeatherDecision d =
      decideWeather(saying(HostWeather{Precipitation::snow, 3, Metres{2000}}, Metres{9000}), p);
  EXPECT_EQ(d.precipitation, Precipitation::snow);
  EXPECT_EQ(d.density, 0.5);
  EXPECT_EQ(d.visibilityM, 2000);
  EXPECT_EQ(d.farM, 2000);
  EXPECT_EQ(d.reason, WeatherReason::host);
  d = decideWeather(saying(HostWeather{Precipitation::snow, 3, Metres{2000}}, Metres{900}), p);
  EXPECT_EQ(d.visibilityM, 900);
  d = decideWeather(saying(HostWeather{Precipitation::rain, 4, {}}), p);
  EXPECT_EQ(d.density, 0.75);
  EXPECT_NEAR(d.visibilityM, 40000 * 0.175, 1e-9) << "half way from medium to heavy";
  d = decideWeather(saying({}, Metres{9000}), p);
  EXPECT_EQ(d.precipitation, Precipitation::none);
  EXPECT_EQ(d.visibilityM, 9000);
  d = decideWeather(saying(HostWeather{}), p);
  EXPECT_FALSE(d.fogged);
  EXPECT_EQ(d.reason, WeatherReason::host);
  d = decideWeather(saying(HostWeather{Precipitation::none, 0, Metres{100}}), p);
  EXPECT_FALSE(d.fogged) << "the layer is off";
}

TEST(HostWeather, fallsBackToThePresetUntilTheHostSpeaks) {
  TuningParameters p = byHost();
  p.weather.step = WeatherStep::snow_light;
  const WeatherDecision d = decideWeather(AircraftState{}, p);
  EXPECT_EQ(d.precipitation, Precipitation::snow);
  EXPECT_EQ(d.reason, WeatherReason::host_said_nothing);
}

TEST(HostWeather, ofUnusableVisibilityIsDefined) {
  for (const double bad : {0.0, -1.0, -kInfinity, kNan}) {
    SCOPED_TRACE(bad);
    WeatherDecision d = decideWeather(saying({}, Metres{bad}), byHost());
    EXPECT_FALSE(d.fogged);
    EXPECT_EQ(d.farM, kInfinity);
    EXPECT_EQ(d.reason, WeatherReason::invalid_visibility);
    d = decideWeather(saying(HostWeather{Precipitation::rain, 5, Metres{bad}}, Metres{bad}), byHost());
    EXPECT_EQ(d.visibilityM, 4000) << "that of the preset's heavy rain";
    EXPECT_EQ(d.reason, WeatherReason::invalid_visibility);
    d = decideWeather(saying(HostWeather{Precipitation::rain, 5, Metres{bad}}, Metres{700}), byHost());
    EXPECT_EQ(d.visibilityM, 700);
    EXPECT_EQ(d.reason, WeatherReason::host);
  }
  struct Limited {
    double said, drawn;
  };
  for (const Limited c : {Limited{1e-30, 10}, {9.9, 10}, {1e7, 1e6}}) {
    const WeatherDecision d = decideWeather(saying({}, Metres{c.said}), byHost());
    EXPECT_EQ(d.visibilityM, c.drawn);
    EXPECT_EQ(d.farM, c.drawn);
    EXPECT_EQ(d.reason, WeatherReason::visibility_limited);
  }
  const WeatherDecision unlimited = decideWeather(saying({}, Metres{kInfinity}), byHost());
  EXPECT_FALSE(unlimited.fogged);
  EXPECT_EQ(unlimited.farM, kInfinity);
}

TEST(HostWeather, ofSeverityOutsideItsScaleIsHeldToIt) {
  EXPECT_EQ(decideWeather(saying(HostWeather{Precipitation::rain, 99, {}}), byHost()).density, 1);
  EXPECT_EQ(decideWeather(saying(HostWeather{Precipitation::rain, -3, {}}), byHost()).density, 0.1);
  TuningParameters p = byHost();
  p.weather.severityDensity = {{0, 0}, {5, 1}};
  const WeatherDecision d = decideWeather(saying(HostWeather{Precipitation::rain, 0, Metres{500}}), p);
  EXPECT_EQ(d.precipitation, Precipitation::none);
  EXPECT_EQ(d.density, 0);
}

TEST(Weather, hasThePresetsWindUntilAHostSendsOne) {
  TuningParameters p;
  p.weather.windSpeed = MetresPerSecond{8};
  p.weather.windFrom = Degrees{90};
  AircraftState state;
  state.wind = Wind{MetresPerSecond{20}, Degrees{180}, MetresPerSecond{2}};
  const Wind presets{MetresPerSecond{8}, Degrees{90}, MetresPerSecond{0}};
  EXPECT_EQ(windOf(state, p.weather), presets);
  p.weather.source = WeatherSource::host;
  EXPECT_EQ(windOf(state, p.weather), *state.wind);
  EXPECT_EQ(windOf(AircraftState{}, p.weather), presets);
}

TEST(Wind, blowsAwayFromWhereItComes) {
  const auto blows = [](double speed, double from, double up) {
    return eastNorthUp(Wind{MetresPerSecond{speed}, Degrees{from}, MetresPerSecond{up}});
  };
  struct Case {
    double from, east, north;
  };
  for (const auto& [from, east, north] :
       {Case{0, 0, -10}, Case{90, -10, 0}, Case{180, 0, 10}, Case{270, 10, 0}, Case{360, 0, -10},
        Case{225, std::sqrt(50.0), std::sqrt(50.0)}})
    EXPECT_LT(length(blows(10, from, 3) - Vec3{east, north, 3}), 1e-12) << from;
}

TEST(StepParameters, betweenStepsLieOnLines) {
  TuningParameters p;
  p.rainLight.farStretch = Ratio{3};
  const auto at = [&p](double density) { return stepParametersAt(p, Precipitation::rain, density); };
  EXPECT_EQ(at(0).visibilityShare.value(), 1);
  EXPECT_EQ(at(0.125).visibilityShare.value(), 0.75);
  EXPECT_EQ(at(0.125).farStretch.value(), 2);
  EXPECT_EQ(at(0.25).visibilityShare.value(), 0.5);
  EXPECT_EQ(at(0.375).visibilityShare.value(), 0.375);
  EXPECT_EQ(at(1).visibilityShare.value(), 0.1);
  p.rainHeavy.density = Ratio{0.8};
  EXPECT_EQ(at(0.9).visibilityShare.value(), 0.1) << "held beyond the densest";
  EXPECT_EQ(stepParametersAt(p, Precipitation::none, 0.5).visibilityShare.value(), 1);
  EXPECT_EQ(at(kNan).visibilityShare.value(), 1);
  // Steps out of order or of one density: still a number for every density.
  p.rainLight.density = p.rainMedium.density = Ratio{0.5};
  p.rainHeavy.density = Ratio{0.2};
  for (const double density : {0.1, 0.2, 0.5, 0.7, 1.0}) {
    const double share = at(density).visibilityShare.value();
    EXPECT_TRUE(share > 0 && share <= 1) << density;
  }
}

TEST(Weather, explainsItselfInOneLine) {
  EXPECT_EQ(explain(WeatherDecision{}),
            "nothing falls, no fog: clear weather of this preset; no far plane: clear weather is not cut");
  EXPECT_EQ(
      explain(decideWeather(AircraftState{}, inStep(WeatherStep::snow_heavy))),
      "snow of density 1, visibility 1600 m: this preset's weather; far plane at 1600 m, ratio 0.000625: at "
      "the visibility");
  for (int i = 0; i < 8; ++i) {
    WeatherDecision d;
    d.reason = static_cast<WeatherReason>(i);
    EXPECT_EQ(explain(d).find('\n'), std::string::npos);
    EXPECT_FALSE(toText(d.reason).empty());
  }
}

}  // namespace
}  // namespace trimtab::test
