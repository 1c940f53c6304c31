#pragma once

#include "trimtab/preset/parameters.h"

/// Computes the memberships of the flight state, each 0..1 (documents A and B, Table 1 and Eq. 1). NaN and a
/// curve without points give NaN. The cost grows with the points of the curve, and nothing is allocated.
namespace trimtab {

/// Returns the value of the curve at x: the straight line between neighbouring points, constant beyond the
/// ends and to infinity. It is exact at every point, never outside its neighbours' values, and not clamped.
/// The points must be in order of x. Points with the same x are a step; x itself has the value of the last
/// one.
double curveValue(const CurvePoints& curve, double x);

/// Returns the membership of an altitude, by the method that `AltitudeParameters::reading` names: 1 is low.
/// `table` is the curve itself. For the equations each point begins a phase of Eq. 1, with the membership of
/// that point. By an equation, altitudes from `maximum` up have 0, and those beyond an end of the curve have
/// its membership. `equation_b` divides by the phase's membership, as document B prints it; the result is 0
/// if that is 0.
double altitudeMembership(const AltitudeParameters& parameters, double altitudeFt);

/// Returns the membership of a pitch, nose up positive: 1 is nose down, where terrain fills the view.
/// `PitchReading::rounded_step` ignores the curve, and it is not monotone: just above level flight it can be
/// larger than just below. With a step of 0 it gives NaN for an infinite pitch.
double pitchMembership(const PitchParameters& parameters, double pitchDeg);

}  // namespace trimtab
