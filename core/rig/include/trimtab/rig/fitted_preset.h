#pragma once

#include <string>

#include "trimtab/preset/parameters.h"
#include "trimtab/rig/ig_fit.h"

namespace trimtab {

/// Returns the preset for the image generator of a fit. It is limitedTo() the profile, and
/// * terms of the signal `triangles` lie over the load that the flight had: what they span goes to the range
///   from the 5th to the 95th percentile, so that a policy that was tuned at 50,000 to 150,000 triangles
///   works where an image has 18,000 objects or so;
/// * where images were given, lod.screen_space_error_px is the error that the LOD scale's neutral value
/// stands
///   for, so that rules in pixels mean pixels, and the budget's losses are those that were seen.
/// Notes name each change, with `where` as their place. Refuses a fit of another image generator, and
/// one from too few views.
Result<TuningParameters> fittedTo(const IgProfile& profile, const IgFit& fit, TuningParameters preset,
                                  const std::string& where);

}  // namespace trimtab
