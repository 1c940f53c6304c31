#pragma once

#include <optional>

#include "trimtab/frame/weather_decision.h"
#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Sums up how far the wind has carried the air around an eye. A sum over time, so that a wind that changes
/// moves what falls on from where it is.
class AirDrift {
 public:
  /// Adds the wind at `eye` over the time, in seconds, since the latest time so far. Time that goes back by
  /// up to 10 s, as that of an extrapolated eye may when a packet corrects it, is waited for; a longer step
  /// either way begins anew and adds nothing.
  void advance(double time, const GeodeticPosition& eye, const Wind& wind);
  /// Returns the sum, metres in earth-centred axes.
  Vec3 metres() const { return metres_; }

 private:
  static constexpr double kLongestStepS = 10;
  std::optional<double> time_;
  Vec3 metres_;
};

}  // namespace trimtab
