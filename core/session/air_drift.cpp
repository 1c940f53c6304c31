#include "trimtab/session/air_drift.h"

#include <cmath>

namespace trimtab {

void AirDrift::advance(double time, const GeodeticPosition& eye, const Wind& wind) {
  if (!std::isfinite(time)) return;
  const double step = time_ ? time - *time_ : 0;
  if (step < 0 && step >= -kLongestStepS) return;
  time_ = time;
  if (!(step > 0 && step <= kLongestStepS)) return;
  metres_ = metres_ + transposed(eastNorthUp(eye.latitude, eye.longitude)) * (eastNorthUp(wind) * step);
}

}  // namespace trimtab
