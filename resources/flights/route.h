#pragma once

#include <span>
#include <vector>

#include "circuit.h"

/// Flights low over real terrain: the sample's aircraft along a route of way points that were read off the
/// terrain once. Calculated, not recorded.
namespace trimtab::flights {

/// Up the Ado's valley under the Hira mountains (FlightGear scenery, 135-136 E 35-36 N) a few hundred feet
/// above its floor, over the Tochu pass and down to Yase; a climbing turn to 6,000 ft and a dive towards Lake
/// Biwa.
std::vector<CircuitRow> kansaiValley();
/// Up the Khumbu below the summits, through the Western Cwm and over the South Col (7,906 m), down past the
/// Lhotse wall into the Imja's valley.
std::vector<CircuitRow> everestPass();

}  // namespace trimtab::flights
