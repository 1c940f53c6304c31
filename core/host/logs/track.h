#pragma once

#include <optional>
#include <vector>

#include "trimtab/frame/frame.h"

/// What the track of an aircraft says of its attitude.
namespace trimtab {

/// Returns the true course from a to b; nothing if they are less than a metre apart.
std::optional<Degrees> course(const GeodeticPosition& a, const GeodeticPosition& b);

/// Sets pitch and roll, and the heading if asked, from the track: the climb, a turn that slips nowhere, the
/// course. It is smooth to about a second, and holds the last attitude where nothing moves.
void setAttitudeFromTrack(std::vector<AircraftState>& states, bool heading);

/// Returns the mean angle between courses and headings, which are the rows' angles times `scale`; nothing if
/// the aircraft hardly moves.
std::optional<double> headingErrorDeg(const std::vector<AircraftState>& states, double scale);

}  // namespace trimtab
