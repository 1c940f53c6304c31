#include "resources/flights/circuit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <sstream>
#include <vector>

#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/flight.h"

namespace trimtab {
namespace {

constexpr double kFoot = 0.3048, kGravity = 9.81;

const Flight& sample() {
  static const Flight flight = [] {
    Result<Flight> read = readFlight(test::sourceDir() / "resources/flights/yecheon-circuit.csv");
    EXPECT_TRUE(read.ok()) << toString(read.findings());
    EXPECT_TRUE(read.findings().empty()) << "a flight of our own has no flaws: " << toString(read.findings());
    return read ? *read : Flight{};
  }();
  return flight;
}

std::vector<double> numbers(const std::string& line) {
  std::vector<double> values;
  std::istringstream cells(line);
  std::string cell;
  while (std::getline(cells, cell, ',')) values.push_back(std::stod(cell));
  return values;
}

// Sines may differ in the last digit between machines, and the last printed digit with them.
TEST(SampleFlight, isWhatTheGeneratorWrites) {
  std::istringstream ours(flights::circuitCsv(flights::circuit()));
  std::istringstream committed(test::readFile(test::sourceDir() / "resources/flights/yecheon-circuit.csv"));
  std::string a, b;
  std::getline(ours, a);
  std::getline(committed, b);
  ASSERT_EQ(a, b);
  std::size_t rows = 0;
  while (std::getline(ours, a)) {
    ASSERT_TRUE(std::getline(committed, b)) << "row " << rows;
    const std::vector<double> x = numbers(a), y = numbers(b);
    ASSERT_EQ(x.size(), y.size());
    const double tolerance[] = {0, 2e-9, 2e-9, 0.002, 0.0002, 0.0002, 0.0002};
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_NEAR(x[i], y[i], tolerance[i]) << "row " << rows << ": " << b;
    ++rows;
  }
  EXPECT_FALSE(std::getline(committed, b));
  EXPECT_EQ(rows, 6001u);
}

TEST(SampleFlight, hasTenMinutesAtTenHertz) {
  const std::vector<AircraftState>& states = sample().states;
  ASSERT_EQ(states.size(), 6001u);
  EXPECT_EQ(states.back().time, 600);
  for (std::size_t i = 1; i < states.size(); ++i) ASSERT_NEAR(states[i].time - states[i - 1].time, 0.1, 1e-9);
}

TEST(SampleFlight, fliesEachOfItsParts) {
  const std::vector<AircraftState>& states = sample().states;
  const auto feet = [&states](std::size_t i) { return states[i].position.height.value() / kFoot; };
  EXPECT_NEAR(feet(0), 354 + 2.5 / kFoot, 0.01) << "a pilot's eye above the runway";
  double highest = 0, approachLow = 1e9, steepLeft = 0, steepRight = 0, cruise = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double roll = states[i].attitude.roll.value();
    highest = std::max(highest, feet(i));
    if (states[i].time > 300) approachLow = std::min(approachLow, feet(i));
    if (std::abs(roll + 60) < 2) steepLeft += 0.1;
    if (std::abs(roll - 60) < 2) steepRight += 0.1;
    if (std::abs(feet(i) - 9000) < 50) cruise += 0.1;
  }
  EXPECT_GT(highest, 9000);
  EXPECT_GT(cruise, 50) << "seconds";
  EXPECT_GT(steepLeft, 40) << "seconds";
  EXPECT_GT(steepRight, 40) << "seconds";
  EXPECT_LT(approachLow, 354 + 250) << "down to the go-around";
  EXPECT_GT(feet(states.size() - 1), approachLow + 1500) << "and up again";
}

TEST(SampleFlight, movesAsAnAircraftDoes) {
  const std::vector<AircraftState>& states = sample().states;
  const auto position = [&states](std::size_t i) { return toEcef(states[i].position); };
  double fastest = 0, highestG = 0;
  double nod = 0, rollRate = 0, turn = 0;
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    const Vec3 v = (position(i + 1) - position(i)) * 10, u = (position(i) - position(i - 1)) * 10;
    fastest = std::max(fastest, length(v));
    highestG = std::max(highestG, length(v - u) * 10 / kGravity);
    const Attitude a = states[i].attitude, b = states[i + 1].attitude;
    nod = std::max(nod, 10 * std::abs(b.pitch.value() - a.pitch.value()));
    rollRate = std::max(rollRate, 10 * std::abs(b.roll.value() - a.roll.value()));
    turn = std::max(turn, 10 * std::abs(wrapped180(b.heading - a.heading).value()));
  }
  EXPECT_LT(fastest, 200) << "m/s";
  EXPECT_LT(highestG, 2.5);
  EXPECT_LT(nod, 12) << "deg/s";
  EXPECT_LT(rollRate, 35) << "deg/s";
  EXPECT_LT(turn, 10) << "deg/s";
}

TEST(SampleFlight, pointsItsNoseWhereItFlies) {
  const std::vector<AircraftState>& states = sample().states;
  for (std::size_t i = 1; i < states.size(); ++i) {
    const LocalFrame here(states[i - 1].position);
    const Vec3 v = here.fromGeodetic(states[i].position) * 10;
    if (length(v) < 60) continue;
    const Attitude a = states[i].attitude;
    const double pitch = a.pitch.value() * std::numbers::pi / 180,
                 heading = a.heading.value() * std::numbers::pi / 180;
    const Vec3 nose{std::cos(pitch) * std::sin(heading), std::cos(pitch) * std::cos(heading),
                    std::sin(pitch)};
    const double angle = std::acos(std::clamp(dot(nose, normalized(v)), -1.0, 1.0)) * 180 / std::numbers::pi;
    ASSERT_LT(angle, 14) << "angle of attack at " << states[i].time << " s";
  }
}

TEST(SampleFlight, staysNearItsField) {
  const LocalFrame field(GeodeticPosition{Degrees{36.63}, Degrees{128.35}, Metres{108}});
  for (const AircraftState& state : sample().states)
    ASSERT_LT(length(field.fromGeodetic(state.position)), 45000);
}

TEST(SampleFlight, visitsFrustumAndEveryBandOfTheDefaults) {
  const ValidatedParameters p = defaultParameters();
  DecisionMemory memory;
  std::set<int> visited;
  for (const AircraftState& state : sample().states) {
    FrameInput input;
    input.state = state;
    visited.insert(decide(input, p, memory).band);
  }
  EXPECT_EQ(visited, (std::set<int>{-1, 0, 1, 2, 3}));
}

}  // namespace
}  // namespace trimtab
