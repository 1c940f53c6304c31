#include "trimtab/session/ground_doubt.h"

#include <cmath>

#include "trimtab/units/number.h"

namespace trimtab {

Finding toFinding(const GroundDoubt& doubt) {
  const auto metres = [](Metres height) { return numberText(std::round(height.value() * 10) / 10) + " m"; };
  const char* const why = doubt.isAltitude
                              ? ", which is the altitude above sea level: this host knows no ground"
                              : ": this host counts from somewhere else, or has another ground";
  return {Severity::warning, "host", "height above ground", metres(doubt.terrain) + ", over the terrain",
          metres(doubt.host) + why + "; the terrain's is used"};
}

}  // namespace trimtab
