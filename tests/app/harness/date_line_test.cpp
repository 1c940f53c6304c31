#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/experiment/stage.h"
#include "app/harness/flown_frames.h"
#include "tests/core/scene/terrain/synthetic_terrain.h"
#include "trimtab/host/flight.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/terrain/format/database.h"

/// A terrain whose eastern border has a smaller longitude than its western one.
namespace trimtab {
namespace {

std::shared_ptr<const terrain::Database> acrossTheDateLine() {
  static const auto terrain = std::make_shared<const test::SyntheticTerrain>(
      2, 1.0 / 1200, GeodeticPosition{Degrees{-17}, Degrees{179.96}, Metres{0}}, test::mountains);
  return terrain;
}

/// Eastward through it at one latitude, from outside to outside.
Flight eastward() {
  Flight flight;
  for (int i = 0; i < 24; ++i) {
    AircraftState state;
    state.time = i;
    state.packet = static_cast<std::uint64_t>(i);
    state.position = {Degrees{-16.95}, wrapped180(Degrees{179.9 + 0.01 * i}), Metres{3000}};
    flight.states.push_back(state);
  }
  return flight;
}

TEST(DateLine, placesOfTheTerrainLieOverIt) {
  const terrain::TerrainInfo& info = acrossTheDateLine()->info();
  ASSERT_LT(info.northEast.longitude, info.southWest.longitude);
  for (const double part : {0.001, 0.2, 0.5, 0.8, 0.999}) {
    const GeodeticPosition place = scene::placeIn(info, part, 0.5);
    EXPECT_TRUE(acrossTheDateLine()->heightAt(place.latitude, place.longitude)) << part;
    EXPECT_TRUE(scene::liesOver(info, place)) << part;
    EXPECT_LE(std::abs(place.longitude.value()), 180);
  }
  for (const double part : {-0.1, 1.1}) {
    EXPECT_FALSE(scene::liesOver(info, scene::placeIn(info, part, 0.5))) << part;
    EXPECT_FALSE(scene::liesOver(info, scene::placeIn(info, 0.5, part))) << part;
  }
}

TEST(DateLine, rowsOfAFlightAreSampledOnBothSides) {
  const auto rows = harness::sampledRows(eastward(), *acrossTheDateLine(), 100);
  const Flight flight = eastward();
  std::size_t west = 0, east = 0;
  for (const std::size_t row : rows) {
    const GeodeticPosition& at = flight.states[row].position;
    EXPECT_TRUE(acrossTheDateLine()->heightAt(at.latitude, at.longitude)) << row;
    ++(at.longitude.value() > 0 ? west : east);
  }
  EXPECT_EQ(west, 5u) << "179.96 and on, the line itself among them";
  EXPECT_EQ(east, 1u);
}

TEST(DateLine, viewsOfAnExperimentStandOverTheTerrain) {
  experiment::Setup setup;
  setup.terrain = acrossTheDateLine();
  const auto places = experiment::placesOf(setup, 20);
  ASSERT_EQ(places.size(), 20u);
  std::set<double> longitudes;
  for (const experiment::Place& place : places) {
    EXPECT_TRUE(scene::liesOver(setup.terrain->info(), place.ground));
    longitudes.insert(place.ground.longitude.value());
  }
  EXPECT_EQ(longitudes.size(), 3u);
  Flight flight = eastward();
  setup.flight = flight;
  for (const experiment::Place& place : experiment::placesOf(setup, 20))
    EXPECT_TRUE(scene::liesOver(setup.terrain->info(), place.ground));
}

}  // namespace
}  // namespace trimtab
