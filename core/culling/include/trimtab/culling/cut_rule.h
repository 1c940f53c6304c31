#pragma once

#include <cmath>

#include "trimtab/frame/frame_request.h"

namespace trimtab {

/// Moves the distance at which a node is exchanged for its children, by LodParameters::spread. Receives and
/// returns squares of metres. 0 stays 0 and infinity stays infinity.
inline double spreadSquared(double distance2, double spread, double fromM) {
  if (spread == 1) return distance2;
  const double from2 = fromM * fromM;
  return from2 * std::pow(distance2 / from2, spread);
}

/// Says how a cut by screen-space error follows from the geometric errors of nodes and their distances.
struct CutRule {
  double maxErrorPx = 0, lodScale = 1, pixelsPerRadian = 0;
  double spread = 1, spreadFromM = 5000;  ///< LodParameters

  /// Returns the geometric error that the rule accepts per metre of distance; 0 if a spread makes that depend
  /// on the distance.
  double errorOverDistance() const { return spread == 1 ? perDistance() : 0; }
  /// Returns the square of what is accepted per metre before the spread; isTooCoarse takes it.
  double limit() const { return perDistance() * perDistance(); }
  /// Reports whether an error (metres) is too large at a squared distance. An eye inside the box (distance 0)
  /// finds any error too large, and an eye that is not a number finds none.
  bool isTooCoarse(double error, double distance2, double limit) const {
    if (spread == 1) return error * error > limit * distance2;
    return spreadSquared(error * error / limit, spread, spreadFromM) > distance2;
  }
  friend bool operator==(const CutRule&, const CutRule&) = default;

 private:
  double perDistance() const { return maxErrorPx * lodScale / pixelsPerRadian; }
};

/// Holds what a cut of tiles or of patches depends on. As long as the key stays the same, the cut may be
/// kept; a cut of patches depends on the pages that are held, too. Static trees have a key of their own,
/// because their rule is document E's: a distance per metre of error, by a measure of error that the key
/// names.
struct CutKey {
  Vec3 eye;
  CutRule rule;
  friend bool operator==(const CutKey&, const CutKey&) = default;
};

/// Returns the key of what a request asks for. `statedErrorScale` is 1 unless a test plants a defect.
inline CutKey cutKeyOf(const FrameRequest& request, Vec3 eye, double statedErrorScale) {
  return {eye,
          {request.levers.drawn.errorPx / statedErrorScale, request.levers.drawn.lodScale,
           errorPxPerRadian(request), request.levers.drawn.levelSpread, request.spreadFrom.value()}};
}

/// Returns the rule by which a request chooses the levels of objects.
inline CutRule objectRuleOf(const FrameRequest& request) {
  CutRule rule = cutKeyOf(request, {}, 1).rule;
  rule.maxErrorPx = request.levers.drawn.objectErrorPx;
  return rule;
}

}  // namespace trimtab
