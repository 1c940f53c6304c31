#pragma once

#include "trimtab/preset/parameters.h"

/// Memberships of the flight state, each 0..1 (documents A and B, Table 1 and Eq. 1). NaN gives NaN; an
/// infinity gives the curve's end.
namespace trimtab {

/// The straight line between neighbouring points, constant beyond the ends; exact at every point and never
/// outside its neighbours' values. Points with the same x are a step, and x itself has the last one's value.
/// No points: NaN.
double curveValue(const CurvePoints& curve, double x);

/// By the reading that the parameters choose. In the equation readings the curve's points are the phases, and
/// altitudes from `maximum` up give 0. Eq. 1 as B prints it divides by the phase's membership: 0 where that
/// is 0.
double altitudeMembership(const AltitudeParameters& parameters, double altitudeFt);

/// 1 is nose down, where terrain fills the view. `rounded_step` is not monotone around level flight.
double pitchMembership(const PitchParameters& parameters, double pitchDeg);

}  // namespace trimtab
