#include "trimtab/weather/haze_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab {
namespace {

/// -log(1/256): below a level of 255 even with what single precision adds.
const double kHidingDepth = std::log(256.0);
constexpr double kHeightMarginM = 100, kFarthestM = 400e3;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Returns the least share of a ray from the eye to ground of this height that lies in the layer; NaN for any
/// height that is not a number.
double leastShare(double topM, double eyeM, double groundM) {
  const double lower = std::min(eyeM, groundM), higher = std::max(eyeM, groundM);
  if (higher <= topM) return 1;
  return (topM - lower) / (higher - lower);
}

}  // namespace

double lengthInLayer(double eyeM, double rise, double lengthM, double topM) {
  // The points at distance t in the layer are those with t^2 + 2 b t + c <= 0.
  const double b = (kEarthRadiusM + eyeM) * rise;
  const double c = (eyeM - topM) * (2 * kEarthRadiusM + eyeM + topM);
  const double square = b * b - c;
  if (!(square > 0)) return 0;
  // The root that adds numbers of one sign comes first, the other from their product, so that none cancels.
  const double q = -(b + std::copysign(std::sqrt(square), b));
  const double r = c / q;
  return std::clamp(std::max(q, r), 0.0, lengthM) - std::clamp(std::min(q, r), 0.0, lengthM);
}

double safeFarM(double extinctionPerM, double topM, double eyeM, double highestGroundM) {
  if (std::isnan(eyeM) || std::isnan(highestGroundM)) return kUnlimited;
  const double share = leastShare(topM, eyeM + kHeightMarginM, highestGroundM + kHeightMarginM);
  if (!(share > 0) || !(extinctionPerM > 0)) return kUnlimited;
  const double far = kHidingDepth / (extinctionPerM * share);
  return far <= kFarthestM ? far : kUnlimited;
}

}  // namespace trimtab
