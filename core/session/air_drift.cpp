#include "trimtab/session/air_drift.h"

namespace trimtab {

void AirDrift::advance(double time, const GeodeticPosition& eye, const Wind& wind) {
  const double step = time_ ? time - *time_ : 0;
  time_ = time;
  if (!(step > 0 && step <= kLongestStepS)) return;
  metres_ = metres_ + transposed(eastNorthUp(eye.latitude, eye.longitude)) * (eastNorthUp(wind) * step);
}

}  // namespace trimtab
