#pragma once

#include "trimtab/frame/frame_request.h"

namespace trimtab::scene {

/// What a cut by screen-space error depends on apart from the eye: a cut may be kept as long as neither its
/// rule nor its eye changes.
struct CutRule {
  double maxErrorPx = 0, lodScale = 0, pixelsPerRadian = 0;

  /// Returns the geometric error that the rule accepts per metre of distance.
  double errorOverDistance() const { return maxErrorPx * lodScale / pixelsPerRadian; }
  friend bool operator==(const CutRule&, const CutRule&) = default;
};

/// Returns the rule that a request asks for. `statedErrorScale` is 1 unless a test plants a defect.
inline CutRule cutRuleOf(const FrameRequest& request, double statedErrorScale) {
  return {request.lod.screenSpaceError.value() / statedErrorScale, request.decision.lodScale,
          pixelsPerRadian(request.view)};
}

}  // namespace trimtab::scene
