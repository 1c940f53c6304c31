#pragma once

#include "trimtab/host/flight.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::test {

/// Returns a flight eastward 500 m above the highest ground around, with a state each tenth of a second, from
/// a part of the terrain's width on; it covers two fifths of it in ten seconds.
inline Flight straightFlight(const terrain::Database& terrain, double from, double seconds) {
  Flight flight;
  flight.name = "straight";
  for (int i = 0; i <= 10 * seconds; ++i) {
    AircraftState state;
    state.time = i * 0.1;
    state.position = scene::placeIn(terrain.info(), from + 0.004 * i, 0.4);
    const auto ground =
        terrain.highestWithin(state.position.latitude, state.position.longitude, Metres{2000});
    state.position.height = *ground + Metres{500};
    state.attitude = {Degrees{90}, Degrees{-4}, {}};
    flight.states.push_back(state);
  }
  return flight;
}

}  // namespace trimtab::test
