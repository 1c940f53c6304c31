#include "trimtab/fuzzy/membership.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

/// Points whose x is at most `x`.
std::size_t pointsUpTo(const CurvePoints& curve, double x) {
  std::size_t count = 0;
  while (count < curve.size && curve.point[count].x <= x) ++count;
  return count;
}

double printedEquation(const AltitudeParameters& p, double h, bool divided) {
  const std::size_t reached = pointsUpTo(p.curve, h);
  if (reached == 0) return p.curve.point[0].y;
  if (h >= p.maximum.value()) return 0;
  const CurvePoint phase = p.curve.point[reached - 1];
  if (reached == p.curve.size) return phase.y;
  const double fall =
      (h - phase.x) * (p.maximum.value() - h) * p.membershipOffset.value() / p.heightOffset.value();
  if (!divided) return phase.y - fall;
  return phase.y > 0 ? (phase.y - fall) / phase.y : 0;
}

double roundedStep(const PitchParameters& p, double pitch) {
  const double step = p.step.value(), limit = p.limit.value();
  if (pitch == 0) return 0.5;
  return pitch > 0 ? step * (limit - pitch) : 1 - step * (limit + pitch);
}

/// 0..1 whatever an equation yields; NaN stays.
double clamped(double membership) {
  return std::clamp(membership, 0.0, 1.0);
}

}  // namespace

double curveValue(const CurvePoints& curve, double x) {
  if (std::isnan(x) || curve.size == 0) return kNan;
  const std::size_t reached = pointsUpTo(curve, x);
  if (reached == 0) return curve.point[0].y;
  const CurvePoint a = curve.point[reached - 1];
  if (reached == curve.size) return a.y;
  const CurvePoint b = curve.point[reached];
  // Rounding can carry the sum an ulp past b; a membership may not leave its neighbours.
  const auto [low, high] = std::minmax(a.y, b.y);
  return std::clamp(a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)), low, high);
}

double altitudeMembership(const AltitudeParameters& parameters, double altitudeFt) {
  if (std::isnan(altitudeFt) || parameters.curve.size == 0) return kNan;
  switch (parameters.reading) {
    case AltitudeReading::table:
      break;
    case AltitudeReading::equation_a:
      return clamped(printedEquation(parameters, altitudeFt, false));
    case AltitudeReading::equation_b:
      return clamped(printedEquation(parameters, altitudeFt, true));
  }
  return clamped(curveValue(parameters.curve, altitudeFt));
}

double pitchMembership(const PitchParameters& parameters, double pitchDeg) {
  if (std::isnan(pitchDeg)) return kNan;
  if (parameters.reading == PitchReading::rounded_step) return clamped(roundedStep(parameters, pitchDeg));
  return clamped(curveValue(parameters.curve, pitchDeg));
}

}  // namespace trimtab
