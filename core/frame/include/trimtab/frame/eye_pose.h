#pragma once

#include "trimtab/units/linear.h"

namespace trimtab {

/// Where the eye is and how it is turned, in the terrain's local frame.
struct EyePose {
  Vec3 position;  ///< metres, local frame
  Mat3 axes;      ///< rows: right, up, backward (OpenGL eye axes) in the local frame

  friend bool operator==(const EyePose&, const EyePose&) = default;
};

}  // namespace trimtab
