#pragma once

#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/terrain/format/database.h"

/// Flights over any terrain, for comparing policies with fixed settings. Calculated, not recorded; rows are
/// 0.1 s apart. Places are fractions of the terrain's extent, east and north from its south-western corner.
namespace trimtab::bench {

struct Place {
  double east = 0, north = 0;
};

/// Returns a flight at 420 kt that weaves between two places and follows the highest ground within 1 km at a
/// clearance.
Flight lowFlight(const terrain::Database& terrain, Place from, Place to, double clearanceFt);

/// Returns an approach at 140 kt on a path of three degrees from 3,000 ft above a place to the place, with a
/// last turn onto its heading, and ten seconds of rolling out.
Flight approachFlight(const terrain::Database& terrain, Place touchDown, double headingDeg);

/// Returns a flight at 450 kt and a height between two places, with turns of 25 degrees of bank.
Flight cruiseFlight(const terrain::Database& terrain, Place from, Place to, double altitudeFt);

/// Returns the flight with a head that moves as the log says, from `beginS` seconds into it, at 20 rows a
/// second.
Flight withHead(const Flight& flight, const HeadLog& log, double beginS);

}  // namespace trimtab::bench
