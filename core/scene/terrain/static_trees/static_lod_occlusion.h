#pragma once

#include <vector>

#include "trimtab/culling/depth_pyramid.h"

namespace trimtab::scene {

/// Holds what the near nodes of static trees cover, read from the depth buffer before the far ones are drawn.
///
/// The occluders of occlusion.h need a surface without holes and with a bounded slope; scenery promises
/// neither. The image's own depths need neither: each texel of the map is the farthest depth of all pixels
/// that it touches (depth_pyramid.h), so what lies behind it would fail the depth test in every one of them.
class StaticLodOcclusion {
 public:
  /// Reads the depths of the framebuffer that is bound for reading and reduces them to a map of width x
  /// height. Blocks until everything drawn so far is finished.
  void read(int pictureWidth, int pictureHeight, int width, int height);
  const DepthPyramid& pyramid() const { return pyramid_; }

 private:
  std::vector<float> picture_;
  DepthPyramid pyramid_;
};

}  // namespace trimtab::scene
