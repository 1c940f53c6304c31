#pragma once

#include "app/harness/run.h"
#include "tests/core/scene/scene_test.h"

/// A small terrain, a flight over it and a plan to measure it, for tests of runs.
namespace trimtab::harness {

/// 12 km of mountains: a synthetic tile takes its time to make, and runs make many.
inline std::shared_ptr<const test::SyntheticTerrain> hills() {
  static const auto terrain = std::make_shared<const test::SyntheticTerrain>(
      4, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, test::mountains);
  return terrain;
}

/// Through the mountains, low and then high, turning and nosing down.
inline Flight mountainFlight() {
  const auto terrain = hills();
  Flight flight;
  flight.name = "mountains";
  for (int i = 0; i < 60; ++i) {
    AircraftState state;
    state.time = i * 0.5;
    state.packet = static_cast<std::uint64_t>(i);
    const Degrees latitude{36.42 + i * 1e-3}, longitude{128.12 + i * 8e-4};
    const Metres ground = terrain->highestWithin(latitude, longitude, Metres{1}).value_or(Metres{0});
    state.position = {latitude, longitude, ground + Metres{100 + i * 25.0}};
    state.attitude = {Degrees{40 + i * 2.0}, Degrees{10 - i * 0.5}, Degrees{i * 0.5}};
    flight.states.push_back(state);
  }
  return flight;
}

inline Plan smallPlan() {
  Plan plan;
  plan.terrain = hills();
  plan.terrainName = "mountains";
  plan.flights = {{"one", mountainFlight()}};
  TuningParameters coarse = *defaultParameters();
  coarse.lod.screenSpaceError = Pixels{16};
  plan.presets = {{"default", defaultParameters()}, {"coarse", *validate(coarse)}};
  plan.widthPx = 96;
  plan.heightPx = 64;
  plan.frames = 4;
  plan.repeats = 2;
  plan.worst = 1;
  plan.skips = false;
  plan.version = "test";
  return plan;
}

inline const Unit& unitOf(const Results& results, const std::string& preset, const std::string& method) {
  for (const Unit& unit : results.units)
    if (unit.name.preset == preset && unit.name.method == method) return unit;
  ADD_FAILURE() << preset << ' ' << method;
  return results.units.front();
}

}  // namespace trimtab::harness
