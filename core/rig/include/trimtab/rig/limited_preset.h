#pragma once

#include <string>

#include "trimtab/preset/parameters.h"
#include "trimtab/rig/ig_profile.h"
#include "trimtab/units/result.h"

/// Makes a preset one that decides nothing which an image generator does not have.
namespace trimtab {

/// Reports whether the profile's IG follows a lever of a policy. It may follow an allowed error by its LOD
/// scale.
bool follows(const IgProfile& profile, Lever lever);

/// Returns the preset without what the IG does not have: rules keep only the settings of levers that it has,
/// within its ranges, and a rule without a setting is left out; head motion, budget and culling scheme leave
/// the other levers alone. So nothing is filtered in flight, and every program decides alike. Notes name each
/// change, with `where` as their place. The policy must be one that policyOf() reads; else it stays as it is.
Result<TuningParameters> limitedTo(const IgProfile& profile, TuningParameters preset,
                                   const std::string& where);

}  // namespace trimtab
