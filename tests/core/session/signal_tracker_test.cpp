#include "trimtab/session/signal_tracker.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace trimtab {
namespace {

AircraftState stateAt(double time, double headingDeg = 0, double pitchDeg = 0) {
  AircraftState state;
  state.time = time;
  state.position = {Degrees{36}, Degrees{128}, Metres{304.8}};
  state.attitude = {Degrees{headingDeg}, Degrees{pitchDeg}, Degrees{0}};
  return state;
}

void push(SignalTracker& tracker, const AircraftState& state) {
  tracker.push(state, std::nullopt, std::nullopt, {});
}

TEST(SignalTracker, knowsOfOneStateWhatNeedsNoOther) {
  SignalTracker tracker;
  for (const SignalRow& row : kSignalRows) EXPECT_TRUE(std::isnan(tracker.values()[row.signal])) << row.key;
  AircraftState state = stateAt(5, 0, -3);
  state.attitude.roll = Degrees{-30};
  WeatherDecision weather;
  weather.visibilityM = 1500;
  weather.density = 0.25;
  tracker.push(state, Metres{30.48},
               Velocity{MetresPerSecond{30}, MetresPerSecond{40}, MetresPerSecond{-5.08}}, weather);
  const SignalValues& v = tracker.values();
  EXPECT_DOUBLE_EQ(v[Signal::altitude], 1000);
  EXPECT_DOUBLE_EQ(v[Signal::above_ground], 100);
  EXPECT_EQ(v[Signal::pitch], -3);
  EXPECT_EQ(v[Signal::roll], 30);
  EXPECT_NEAR(v[Signal::speed], std::sqrt(2525.8064) / 0.514444444, 1e-6);
  EXPECT_NEAR(v[Signal::climb], 1000, 1e-9);
  EXPECT_EQ(v[Signal::visibility], 1500);
  EXPECT_EQ(v[Signal::precipitation], 0.25);
  EXPECT_TRUE(std::isnan(v[Signal::sight_rate]));
  EXPECT_TRUE(std::isnan(v[Signal::load]));
  state.time = 5.1;
  state.airspeed = Knots{99};
  for (int i = 0; i < 100; ++i) {
    tracker.push(state, std::nullopt, std::nullopt, weather);
    state.time += 0.1;
  }
  EXPECT_NEAR(v[Signal::speed], 99, 1e-6) << "the airspeed comes first";
  EXPECT_TRUE(std::isnan(v[Signal::climb]));
  EXPECT_TRUE(std::isnan(v[Signal::above_ground]));
}

TEST(SignalTracker, measuresATurnOfAnyRateThroughNorthAndWithIrregularSteps) {
  std::mt19937 random(19);
  std::uniform_real_distribution<double> step(0.002, 0.1);
  for (const double rate : {0.5, 3.0, 90.0, 180.0, -180.0, 720.0}) {
    SignalTracker tracker;
    double t = 1.7e9;  // a clock of the epoch
    for (int i = 0; i < 400; ++i, t += step(random))
      push(tracker, stateAt(t, std::fmod(350 + rate * (t - 1.7e9), 360.0)));
    EXPECT_NEAR(tracker.values()[Signal::sight_rate], std::abs(rate), 1e-3 * std::abs(rate)) << rate;
  }
}

TEST(SignalTracker, separatesTheHeadFromTheAircraft) {
  SignalTracker tracker;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.005 * i;
    AircraftState state = stateAt(t, 20 * t);
    state.head = Attitude{Degrees{160 * t}, Degrees{0}, Degrees{0}};
    push(tracker, state);
  }
  EXPECT_NEAR(tracker.values()[Signal::head_rate], 160, 0.01);
  EXPECT_NEAR(tracker.values()[Signal::sight_rate], 180, 0.01);
  AircraftState without = stateAt(1.0, 20);
  push(tracker, without);
  EXPECT_TRUE(std::isnan(tracker.values()[Signal::head_rate]));
}

TEST(SignalTracker, reachesAStepAlikeAtAnyHostRate) {
  const double tau = rowOf(Signal::speed).filterS;
  for (const double hz : {5.0, 10.0, 60.0, 500.0}) {
    SignalTracker tracker;
    AircraftState state = stateAt(0);
    state.airspeed = Knots{100};
    push(tracker, state);
    state.airspeed = Knots{200};
    const int steps = static_cast<int>(std::lround(tau * hz));
    for (int i = 1; i <= steps; ++i) {
      state.time = i / hz;
      push(tracker, state);
    }
    EXPECT_NEAR(tracker.values()[Signal::speed], 200 - 100 * std::exp(-steps / hz / tau), 1e-9) << hz;
  }
}

TEST(SignalTracker, beginsAnewAfterAGapAndWhereTimeGoesBack) {
  for (const double next : {12.5, 3.0, kNan, kInfinity}) {
    SignalTracker tracker;
    push(tracker, stateAt(10, 0));
    push(tracker, stateAt(10.1, 10));
    EXPECT_NEAR(tracker.values()[Signal::sight_rate], 100, 1e-6);
    push(tracker, stateAt(next, 180));
    EXPECT_TRUE(std::isnan(tracker.values()[Signal::sight_rate])) << next;
    const double base = std::isfinite(next) ? next : 20;
    push(tracker, stateAt(base + 0.1, 181));
    push(tracker, stateAt(base + 0.2, 182));
    EXPECT_NEAR(tracker.values()[Signal::sight_rate], 10, 1e-6) << next;
  }
}

TEST(SignalTracker, ignoresTheSameMomentTwice) {
  SignalTracker tracker;
  push(tracker, stateAt(1, 0));
  push(tracker, stateAt(1.1, 1));
  const double before = tracker.values()[Signal::sight_rate];
  push(tracker, stateAt(1.1, 90));
  EXPECT_EQ(tracker.values()[Signal::sight_rate], before);
}

TEST(SignalTracker, callsWhatIsNotANumberUnknownAndRecovers) {
  SignalTracker tracker;
  push(tracker, stateAt(1));
  AircraftState bad = stateAt(1.1, kNan, kNan);
  bad.position.height = Metres{kInfinity};
  bad.airspeed = Knots{kNan};
  push(tracker, bad);
  for (const Signal s : {Signal::altitude, Signal::pitch, Signal::speed, Signal::sight_rate})
    EXPECT_TRUE(std::isnan(tracker.values()[s])) << rowOf(s).key;
  push(tracker, stateAt(1.2, 5));
  push(tracker, stateAt(1.3, 6));
  EXPECT_NEAR(tracker.values()[Signal::sight_rate], 10, 1e-6);
  EXPECT_DOUBLE_EQ(tracker.values()[Signal::altitude], 1000);
}

TEST(SignalTracker, takesTheMedianLoadSoThatASpikeDrivesNothing) {
  SignalTracker tracker;
  for (int i = 0; i < 9; ++i) tracker.finished(8, 16, 1000);
  EXPECT_EQ(tracker.values()[Signal::load], 0.5);
  tracker.finished(500, 16, 2000);
  EXPECT_EQ(tracker.values()[Signal::load], 0.5);
  EXPECT_EQ(tracker.values()[Signal::triangles], 2000);
  for (const double work : {0.0, -1.0, kNan, kInfinity}) tracker.finished(work, 16, 1);
  for (const double budget : {0.0, -1.0, kNan, kInfinity}) tracker.finished(8, budget, 1);
  EXPECT_EQ(tracker.values()[Signal::load], 0.5);
  for (int i = 0; i < 5; ++i) tracker.finished(32, 16, 1);
  EXPECT_EQ(tracker.values()[Signal::load], 2) << "load that lasts counts";
}

TEST(SignalTracker, letsTrianglesTurnRoundForALargeChangeOnlyAndRestWithTheView) {
  SignalTracker tracker;
  const double& triangles = tracker.values().value[indexOf(Signal::triangles)];
  double time = 0;
  const auto image = [&](double headingDeg, std::uint64_t count) {
    push(tracker, stateAt(time += 0.02, headingDeg));
    tracker.finished(1, 10, count);
    return triangles;
  };
  EXPECT_EQ(image(10, 1000), 1000);
  EXPECT_EQ(image(20, 3000), 3000) << "a turn brings more into view";
  EXPECT_EQ(image(20, 2500), 3000) << "a lever may have caused so small a change";
  EXPECT_EQ(image(20, 3001), 3001) << "on the way that it goes any change counts";
  EXPECT_EQ(image(20, 2000), 2000);
  EXPECT_EQ(image(20.01, 1900), 1900);
  EXPECT_EQ(image(20, 2600), 2600);
  EXPECT_EQ(image(20, 1000), 2600) << "it has turned twice, and the view rests";
  EXPECT_EQ(image(20, 2700), 2700);
  EXPECT_EQ(image(20.1, 1000), 1000) << "the view has moved";
  tracker.imageChanged();
  EXPECT_EQ(image(20.1, 1100), 1100) << "other parameters, another image";
  for (int i = 1; i < 9; ++i) {
    AircraftState state = stateAt(time += 0.02, 20.1);
    state.position.height = state.position.height + Metres{1.5 * i};
    push(tracker, state);
    tracker.finished(1, 10, i % 2 == 0 ? 500 : 1200);
    EXPECT_EQ(triangles, i % 2 == 0 ? 500 : 1200) << "a climb is no rest";
  }
}

TEST(SignalTracker, letsTheLoadTurnRoundBeyondItsNoiseAndOnlyRiseOnceTheViewRests) {
  SignalTracker tracker;
  const double& load = tracker.values().value[indexOf(Signal::load)];
  double time = 0;
  const auto nine = [&](double headingDeg, double workMs) {
    push(tracker, stateAt(time += 0.02, headingDeg));
    for (int i = 0; i < 9; ++i) tracker.finished(workMs, 10, 1000);
    return load;
  };
  EXPECT_EQ(nine(10, 10), 1);
  EXPECT_EQ(nine(10, 12), 1.2);
  EXPECT_EQ(nine(10, 11), 1.2) << "noise";
  EXPECT_EQ(nine(10, 13), 1.3) << "on the way that it goes any change counts";
  EXPECT_EQ(nine(10, 6), 0.6) << "turned once";
  EXPECT_EQ(nine(10, 9), 0.9) << "turned twice";
  EXPECT_EQ(nine(10, 6), 0.9) << "the view rests: a lever that follows the load would swing";
  EXPECT_EQ(nine(10, 20), 2) << "another program may take the machine";
  EXPECT_EQ(nine(10, 6), 2);
  EXPECT_EQ(nine(11, 6), 0.6) << "the view has moved";
}

}  // namespace
}  // namespace trimtab
