#pragma once

#include "trimtab/preset/parameters.h"

/// Computes the memberships of the flight state, each 0..1 (documents A and B, Table 1 and Eq. 1). NaN gives
/// NaN, and an infinity gives the value at the curve's end.
namespace trimtab {

/// Returns the value of the curve at x: the straight line between neighbouring points, constant beyond the
/// ends. It is exact at every point and never outside its neighbours' values. Points with the same x are a
/// step; x itself has the value of the last one. A curve without points gives NaN.
double curveValue(const CurvePoints& curve, double x);

/// Returns the membership of an altitude in the reading that the parameters choose. In the equation readings
/// the curve's points are the phases, and altitudes from `maximum` up give 0. Eq. 1 as document B prints it
/// divides by the phase's membership; the result is 0 if that is 0.
double altitudeMembership(const AltitudeParameters& parameters, double altitudeFt);

/// Returns the membership of a pitch, nose up positive: 1 is nose down, where terrain fills the view.
/// `rounded_step` is not monotone around level flight.
double pitchMembership(const PitchParameters& parameters, double pitchDeg);

}  // namespace trimtab
