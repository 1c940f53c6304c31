#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "tests/support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

constexpr double kImageS = 1.0 / 60;

/// Ridges 400 m high every 12 km or so, so that flights of any place have heights above ground.
class Ridges : public GroundHeights {
 public:
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return Metres{200 * (1 + std::sin(latitude.value() * 60) * std::cos(longitude.value() * 45))};
  }
};

FrameResult resultCosting(double ms, std::uint64_t triangles) {
  FrameResult result;
  result.cost.total = ms;
  result.visible.triangles = triangles;
  return result;
}

/// A policy that flies: every step is checked against the levers' rows.
class Pilot {
 public:
  explicit Pilot(const ValidatedParameters& parameters) : parameters_(parameters), session_(parameters) {
    session_.setGround(std::make_shared<Ridges>());
  }

  void fly(const AircraftState& state, double workMs) {
    session_.fly(state, state.time);
    ASSERT_TRUE(session_.request(state.time, 320, 180));
    session_.finished(resultCosting(workMs, 40'000), state.time);
    const PolicyOutcome& now = session_.decision().policy;
    for (const LeverRow& row : kLeverRows) {
      if (!parameters_.policy()->moves(row.lever)) {
        ASSERT_FALSE(now.moves(row.lever));
        continue;
      }
      const double value = now[row.lever];
      ASSERT_TRUE(value >= row.hard.low && value <= row.hard.high) << row.key << " " << value;
      if (!begun_) continue;
      const double step = std::min(std::max(state.time - time_, 0.0), 0.25);
      const double before = last_[row.lever];
      const double change = row.logarithmic ? std::log2(value / before) : value - before;
      ASSERT_LE(std::abs(change), row.ratePerS * step + 1e-9) << row.key << " at " << state.time << " s";
      if (change != 0) {
        changes_ += change * direction_[row.lever] < 0;
        direction_[row.lever] = change;
      }
    }
    last_ = now;
    time_ = std::isfinite(state.time) ? state.time : time_;
    begun_ = true;
  }

  /// Holds a state. The filters of speed and climb follow for a while, then nothing may move any more.
  void rest(AircraftState state) {
    constexpr double kFollowS = 6, kRestS = 6;
    state.velocity = Velocity{};
    const double from = state.time;
    PolicyOutcome settled;
    changes_ = 0;
    for (int i = 1; i < (kFollowS + kRestS) / kImageS; ++i) {
      state.time = from + i * kImageS;
      fly(state, 12);
      if (testing::Test::HasFatalFailure()) return;
      if (state.time - from <= kFollowS) settled = last_;
      if (state.time - from > kFollowS) {
        ASSERT_EQ(last_, settled) << "a lever moves while all inputs rest";
      }
    }
    EXPECT_LE(changes_, kLevers) << "levers go one way to their rest, or once about";
  }

  std::size_t reversals() const { return changes_; }

 private:
  const ValidatedParameters& parameters_;
  Session session_;
  PolicyOutcome last_;
  LeverValues direction_ = LeverValues::all(0);
  double time_ = 0;
  std::size_t changes_ = 0;
  bool begun_ = false;
};

class ShippedPoliciesFly : public testing::TestWithParam<const char*> {
 protected:
  ShippedPoliciesFly() : parameters_(*validate(loadPreset(GetParam())->parameters)) {}

  /// At 60 images a second, with a load that wanders and a spike now and then.
  void flyAll(const Flight& flight, const HeadLog* head, double seconds = 1e9) {
    ASSERT_NE(parameters_.policy(), nullptr);
    Pilot pilot(parameters_);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> jitter(0.8, 1.2);
    AircraftState state;
    const double end = std::min(flight.durationS(), seconds);
    std::size_t images = 0;
    for (double t = 0; t < end; t += kImageS, ++images) {
      state = stateAt(flight, flight.beginS() + t);
      if (head) state.head = headAt(*head, t);
      const double wander = 14 + 8 * std::sin(t / 7);
      pilot.fly(state, (images % 97 == 0 ? 10 : 1) * wander * jitter(random));
      ASSERT_FALSE(HasFatalFailure()) << flight.name;
    }
    std::printf("%s over %s%s: %zu images, levers turn round %.2f times a second\n", GetParam(),
                flight.name.c_str(), head ? " with a head" : "", images,
                double(pilot.reversals()) / std::max(end, 1.0));
    pilot.rest(state);
  }

  ValidatedParameters parameters_;
};

TEST_P(ShippedPoliciesFly, keepLeversInRangeAndRateOverTheShippedFlights) {
  for (const char* name : {"yecheon-circuit", "kansai-valley", "everest-pass"}) {
    const auto flight = readFlight(test::sourceDir() / "resources/flights" / (std::string(name) + ".csv"));
    ASSERT_TRUE(flight) << toString(flight.findings());
    flyAll(*flight, nullptr);
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST_P(ShippedPoliciesFly, keepLeversInRangeAndRateOverRecordedFlightsAndHeads) {
  const auto data = test::sharedDir() / "data";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "needs " << data;
  const auto keflavik = readFlight(data / "flight-fg-keflavik/reg_flight.csv");
  ASSERT_TRUE(keflavik) << toString(keflavik.findings());
  for (const char* user : {"user1_euler.txt", "user2_euler.txt"}) {
    const auto head = readHeadLog(data / "headmotion-mv360" / user, BadRows::leave_out);
    ASSERT_TRUE(head) << toString(head.findings());
    flyAll(*keflavik, &*head, 120);
    ASSERT_FALSE(HasFatalFailure());
  }
}

/// Irregular steps, gaps, time that goes back, jumps, and noise on all that a host sends.
TEST_P(ShippedPoliciesFly, keepLeversInRangeAndRateOverRandomFlights) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even;
  for (int flight = 0; flight < 40; ++flight) {
    Pilot pilot(parameters_);
    AircraftState state;
    state.position = {Degrees{36 + even(random)}, Degrees{128 + even(random)}, Metres{3000 * even(random)}};
    double heading = 0, climb = 0, turn = 0;
    for (int i = 0; i < 1500; ++i) {
      const double what = even(random);
      const double step = what < 0.01    ? 2 * even(random)
                          : what < 0.015 ? -even(random)
                                         : kImageS * 2 * even(random);
      state.time += step;
      ++state.packet;
      if (even(random) < 0.02) climb = 40 * normal(random), turn = 30 * normal(random);
      heading += turn * step;
      state.position.height = Metres{std::clamp(state.position.height.value() + climb * step, 0.0, 15000.0)};
      state.position.longitude = Degrees{state.position.longitude.value() + step * 2e-3};
      state.attitude = {Degrees{std::remainder(heading + normal(random), 360)}, Degrees{climb / 4},
                        Degrees{turn + 3 * normal(random)}};
      state.head.reset();
      if (flight % 2 == 0)
        state.head = Attitude{Degrees{90 * std::sin(state.time * (1 + flight))}, Degrees{normal(random)}, {}};
      state.visibility.reset();
      if (flight % 3 == 0) state.visibility = Metres{500 + 20000 * even(random)};
      pilot.fly(state, 40 * even(random));
      ASSERT_FALSE(HasFatalFailure()) << "flight " << flight << ", state " << i;
    }
    pilot.rest(state);
    ASSERT_FALSE(HasFatalFailure()) << "flight " << flight;
  }
}

/// Wheels, struts and noise of the terrain: a few feet at touch-down must not move anything.
TEST_P(ShippedPoliciesFly, flickerAtNothingWhileTheWheelsTouchTheGround) {
  Session session(parameters_);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> feet(0, 4);
  AircraftState state;
  state.position = {Degrees{36.6}, Degrees{128.4}, Metres{100}};
  state.velocity = Velocity{MetresPerSecond{60}, {}, {}};
  PolicyOutcome first;
  for (int i = 0; i < 600; ++i) {
    state.time = i * kImageS;
    state.aboveGround = Feet{feet(random)}.as<Metres>();
    session.fly(state, state.time);
    if (i == 120) first = session.decision().policy;
    if (i > 120) {
      ASSERT_EQ(session.decision().policy, first) << "image " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, ShippedPoliciesFly,
                         testing::Values("low-level", "approach", "helmet-search", "high-cruise"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace trimtab
