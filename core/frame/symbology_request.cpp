#include "trimtab/frame/symbology_request.h"

namespace trimtab {

SymbologySetup symbologySetup(const TuningParameters& p) {
  return {p.symbology,
          {p.symbolPitchLadder, p.symbolAircraftReference, p.symbolFlightPath, p.symbolLineOfSight,
           p.symbolHeadingTape, p.symbolAirspeed, p.symbolAltitude, p.symbolHost}};
}

}  // namespace trimtab
