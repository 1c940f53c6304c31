#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/light_index.h"

/// Selects the lights that a frame draws, by cell.
namespace trimtab {

struct LightQuery {
  EyePose eye = {};  ///< in the index's frame
  ViewShape view = {};
  double sizePx = 0;  ///< of a light across, in pixels of `view`; 0 selects nothing
  bool cull = true;   ///< if false, every cell is selected
  /// Nothing can be seen through more air than this, metres.
  double airM = std::numeric_limits<double>::infinity();
  friend bool operator==(const LightQuery&, const LightQuery&) = default;
};

/// Replaces `cells` by the numbers of those that may have a light in the image, in order. A light is in the
/// image as soon as half its size reaches into it, so cells are tested against a view that is wider by half a
/// light. The horizon hides no lights: its proof is about boxes in space, and a light of some pixels stands
/// out over the ridge that hides its centre.
void selectLights(const LightIndex& lights, const LightQuery& query, std::vector<std::uint32_t>& cells);

}  // namespace trimtab
