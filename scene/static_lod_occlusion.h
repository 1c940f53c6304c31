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
  StaticLodOcclusion() = default;
  ~StaticLodOcclusion();
  StaticLodOcclusion(const StaticLodOcclusion&) = delete;
  StaticLodOcclusion& operator=(const StaticLodOcclusion&) = delete;

  /// Waits for what was drawn so far. Leaves framebuffer, viewport, program and texture unit to be restored.
  void read(unsigned depthTexture, int pictureWidth, int pictureHeight, int width, int height);
  const DepthPyramid& pyramid() const { return pyramid_; }

 private:
  void make();
  void resize(int width, int height);

  unsigned program_ = 0, frame_ = 0, map_ = 0, emptyArray_ = 0;
  int storedWidth_ = 0, storedHeight_ = 0;
  std::vector<float> depths_;
  DepthPyramid pyramid_;
};

}  // namespace trimtab::scene
