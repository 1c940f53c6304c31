#pragma once

#include <vector>

#include "trimtab/culling/depth_pyramid.h"

namespace trimtab::scene {

/// What the near nodes of static trees cover, read from the picture itself before the far ones are drawn.
///
/// The occluders of occlusion.h need a surface without holes and with a bounded slope; scenery promises
/// neither. The picture's own depths need nothing: each texel of the map is the farthest depth of all pixels
/// that it touches (depth_pyramid.h), so what lies behind it would fail the depth test in every one of them.
class StaticLodOcclusion {
 public:
  /// Of the framebuffer that is bound for reading, as a map of width x height. Waits for what was drawn so
  /// far.
  void read(int pictureWidth, int pictureHeight, int width, int height);
  const DepthPyramid& pyramid() const { return pyramid_; }

 private:
  std::vector<float> picture_;
  DepthPyramid pyramid_;
};

}  // namespace trimtab::scene
