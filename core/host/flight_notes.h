#pragma once

#include <string>

#include "trimtab/host/flight.h"

namespace trimtab {

/// Notes on the silences and jumps of a flight, with their times and distances; at most ten of them one by
/// one.
void appendMotionNotes(const Flight& flight, const std::string& where, Findings& findings);

}  // namespace trimtab
