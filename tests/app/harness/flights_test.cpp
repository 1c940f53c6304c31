#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "resources/flights/route.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

struct Generated {
  const char *name, *data;
  std::vector<flights::CircuitRow> (*fly)();
  double lowestM;  ///< what it keeps above the ground, at least
};
const Generated kFlights[] = {{"kansai-valley", "fg-kansai-e135n35", flights::kansaiValley, 60},
                              {"everest-pass", "dem-srtm3-everest", flights::everestPass, 120}};

Flight read(const Generated& generated) {
  Result<Flight> flight =
      readFlight(test::sourceDir() / "resources/flights" / (std::string(generated.name) + ".csv"));
  EXPECT_TRUE(flight && flight.findings().empty()) << toString(flight.findings());
  return flight ? std::move(flight).value() : Flight{};
}

std::vector<double> numbers(const std::string& line) {
  std::vector<double> values;
  std::istringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
  return values;
}

// Sines may differ in the last digit between machines, and the last printed digit with them.
TEST(RouteFlights, areWhatTheGeneratorWrites) {
  for (const Generated& generated : kFlights) {
    std::istringstream ours(flights::circuitCsv(generated.fly()));
    std::istringstream committed(
        test::readFile(test::sourceDir() / "resources/flights" / (std::string(generated.name) + ".csv")));
    std::string a, b;
    std::getline(ours, a);
    std::getline(committed, b);
    ASSERT_EQ(a, b);
    while (std::getline(ours, a)) {
      ASSERT_TRUE(std::getline(committed, b)) << generated.name;
      const std::vector<double> x = numbers(a), y = numbers(b);
      ASSERT_EQ(x.size(), y.size());
      const double tolerance[] = {0, 1e-8, 1e-8, 0.01, 0.001, 0.001, 0.001};
      for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(x[i], y[i], tolerance[i]) << generated.name << ' ' << b;
    }
    EXPECT_FALSE(std::getline(committed, b));
  }
}

TEST(RouteFlights, flyAsAnAircraftCan) {
  for (const Generated& generated : kFlights) {
    const Flight flight = read(generated);
    for (std::size_t i = 1; i < flight.states.size(); ++i) {
      const AircraftState &a = flight.states[i - 1], &b = flight.states[i];
      ASSERT_NEAR(b.time - a.time, 0.1, 1e-9);
      const Vec3 step = toEcef(b.position) - toEcef(a.position);
      const double speed = length(step) / 0.1;
      ASSERT_GT(speed, 120) << generated.name << ' ' << b.time;
      ASSERT_LT(speed, 180) << generated.name << ' ' << b.time;
      ASSERT_LE(std::abs(b.attitude.roll.value()), 60) << generated.name << ' ' << b.time;
      ASSERT_LT(std::abs(std::remainder(b.attitude.roll.value() - a.attitude.roll.value(), 360)), 5);
      ASSERT_LT(std::abs(b.attitude.pitch.value() - a.attitude.pitch.value()), 2);
    }
  }
}

TEST(RouteFlights, makeTheShippedPresetsChangeTheirBands) {
  for (const Generated& generated : kFlights)
    for (const char* name : {"default", "as-published"}) {
      const Result<Preset> preset = loadPreset(name);
      ASSERT_TRUE(preset);
      Session session(*validate(preset->parameters));
      int changes = -1;
      std::pair<Scheme, int> before{Scheme::frustum, -2};
      for (const AircraftState& state : read(generated).states) {
        session.fly(state, state.time);
        const std::pair now{session.decision().scheme, session.decision().band};
        changes += now != before;
        before = now;
      }
      EXPECT_GE(changes, 3) << generated.name << " by " << name;
    }
}

TEST(RouteFlights, stayAboveTheGroundAndOverTheData) {
  for (const Generated& generated : kFlights) {
    TRIMTAB_NEEDS_SHARED(std::filesystem::path("data") / generated.data);
    const auto terrain = test::bakedOnce(generated.data);
    ASSERT_TRUE(terrain) << toString(terrain.findings());
    double lowest = std::numeric_limits<double>::infinity(), highest = 0, low = 0;
    const Flight flight = read(generated);
    for (const AircraftState& state : flight.states) {
      const auto ground = (*terrain)->heightAt(state.position.latitude, state.position.longitude);
      ASSERT_TRUE(ground) << generated.name << " leaves the data at " << state.time;
      lowest = std::min(lowest, (state.position.height - *ground).value());
      highest = std::max(highest, state.position.height.value());
      // Nearby ground is higher: in a valley.
      const auto ridge =
          (*terrain)->highestWithin(state.position.latitude, state.position.longitude, Metres{3000});
      low += ridge && *ridge > state.position.height;
    }
    EXPECT_GT(lowest, generated.lowestM) << generated.name;
    EXPECT_GT(low / static_cast<double>(flight.states.size()), 0.4)
        << generated.name << " is not in a valley";
    EXPECT_GT(highest, generated.data[0] == 'f' ? 1800 : 7906) << generated.name;
  }
}

}  // namespace
}  // namespace trimtab
