#include "trimtab/session/precipitation_fade.h"

#include <gtest/gtest.h>

#include <limits>

#include "trimtab/session/session.h"

namespace trimtab {
namespace {

WeatherDecision weather(Precipitation kind, double density) {
  WeatherDecision w;
  w.precipitation = kind;
  w.density = density;
  return w;
}
const WeatherDecision kDry = weather(Precipitation::none, 0), kRain = weather(Precipitation::rain, 0.5),
                      kSnow = weather(Precipitation::snow, 1);

TEST(PrecipitationFade, beginsWithTheDecision) {
  PrecipitationFade fade;
  fade.advance(5, kRain);
  EXPECT_FALSE(fade.fading());
}

TEST(PrecipitationFade, risesAndFallsWithoutAStepBack) {
  PrecipitationFade fade;
  fade.advance(0, kDry);
  double time = 0, before = 0;
  fade.advance(time, kRain);
  for (; fade.fading(); time += 0.05, fade.advance(time, kRain)) {
    EXPECT_EQ(fade.fading()->kind, Precipitation::rain);
    EXPECT_EQ(fade.fading()->density, 0.5) << "size and speed are those that are coming";
    EXPECT_GE(fade.fading()->amount, before);
    EXPECT_LE(fade.fading()->amount, before + 0.05 / PrecipitationFade::kFullS + 1e-9);
    before = fade.fading()->amount;
    ASSERT_LT(time, 20);
  }
  EXPECT_NEAR(time, 0.5 * PrecipitationFade::kFullS, 0.2);
  const double stopped = time;
  before = 0.5;
  for (time += 0.05, fade.advance(time, kDry); fade.fading(); time += 0.05, fade.advance(time, kDry)) {
    EXPECT_EQ(fade.fading()->kind, Precipitation::rain);
    EXPECT_EQ(fade.fading()->density, 0.5) << "size and speed stay what they were";
    EXPECT_LE(fade.fading()->amount, before);
    before = fade.fading()->amount;
    ASSERT_LT(time, 40);
  }
  EXPECT_NEAR(time - stopped, 0.5 * PrecipitationFade::kFullS, 0.2);
}

TEST(PrecipitationFade, endsRainBeforeSnowBegins) {
  PrecipitationFade fade;
  fade.advance(0, kRain);
  bool dry = false;
  double time = 0.1;
  for (fade.advance(time, kSnow); fade.fading(); time += 0.1, fade.advance(time, kSnow)) {
    const FadingPrecipitation f = *fade.fading();
    dry = dry || f.amount == 0;
    EXPECT_EQ(f.kind == Precipitation::snow, dry && f.amount > 0) << time;
    ASSERT_LT(time, 40);
  }
  EXPECT_TRUE(dry);
}

TEST(PrecipitationFade, takesTheDecisionAtOnceAfterAGapOrAnEdit) {
  for (const double time :
       {100.0, -50.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    PrecipitationFade fade;
    fade.advance(0, kDry);
    fade.advance(time, kSnow);
    EXPECT_FALSE(fade.fading()) << time;
  }
  PrecipitationFade fade;
  fade.advance(0, kDry);
  fade.settle();
  fade.advance(0.1, kSnow);
  EXPECT_FALSE(fade.fading());
  fade.advance(0.2, kDry);
  ASSERT_TRUE(fade.fading());
  const double amount = fade.fading()->amount;
  fade.advance(0.15, kDry);
  EXPECT_EQ(fade.fading()->amount, amount) << "a packet corrected the time";
}

TEST(PrecipitationFade, takesADensityThatIsNoNumberAsDry) {
  PrecipitationFade fade;
  fade.advance(0, kDry);
  fade.advance(0.1, weather(Precipitation::rain, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(fade.fading());
  fade.advance(0.2, weather(Precipitation::rain, 7));
  for (int i = 0; i < 100; ++i) fade.advance(0.2 + 0.1 * i, weather(Precipitation::rain, 7));
  EXPECT_FALSE(fade.fading());
}

TEST(PrecipitationFade, ofASessionFollowsTheHostAndNotAnEdit) {
  TuningParameters parameters;
  parameters.weather.source = WeatherSource::host;
  Session session(*validate(parameters));
  const auto request = [&](double time, Precipitation kind) {
    AircraftState state;
    state.time = time;
    state.weather = HostWeather{kind, 5, {}};
    session.fly(state);
    return *session.request(50 + time, 320, 200);
  };
  EXPECT_FALSE(request(0, Precipitation::none).fading);
  const auto raining = request(0.5, Precipitation::rain);
  ASSERT_TRUE(raining.fading);
  EXPECT_GT(raining.fading->amount, 0);
  EXPECT_LT(raining.fading->amount, raining.decision.weather.density);
  parameters.weather.windSpeed = MetresPerSecond{3};
  session.setParameters(*validate(parameters));
  EXPECT_FALSE(request(0.6, Precipitation::rain).fading) << "an edit is shown at once";
}

}  // namespace
}  // namespace trimtab
