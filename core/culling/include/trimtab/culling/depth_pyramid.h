#pragma once

#include <span>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab {

/// A depth map with coarser levels, and the test whether a box lies behind it.
///
/// Each texel holds near / view depth of the *farthest* pixel of the image that it touches, and 0 if one of
/// them is uncovered. So nothing need be known of the surface that covers: holes, steep walls or an eye below
/// the ground leave farther depths, or none. A box is hidden if every texel that its projection touches, and
/// a pixel's width around, shows a depth nearer than the box's nearest point.
class DepthPyramid {
 public:
  /// Builds the map of an image of any size, whose row 0 is at the bottom: each texel gets the farthest pixel
  /// that it touches.
  void build(std::span<const float> picture, int pictureWidth, int pictureHeight, int width, int height);

  /// Returns true only if the box is proven hidden; false for a box that reaches the near plane. Margins
  /// cover float rounding in the image. `view` has the image's size, which need not be a multiple of the
  /// map's.
  bool isHidden(const Box& box, const EyePose& eye, const ViewShape& view) const;
  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns the finest level.
  std::span<const float> depths() const;

 private:
  struct Level {
    std::size_t first = 0;
    int width = 0, height = 0;
  };
  void resize(int width, int height);
  void reduce();
  /// Returns true if every texel from (x0, y0) to (x1, y1), both inside the map, is nearer than `limit`,
  /// which is near / depth. Looks at coarse levels first and stops as soon as the answer is known.
  bool covers(int x0, int y0, int x1, int y1, float limit) const;
  bool coversWithin(std::size_t level, int x0, int y0, int x1, int y1, float limit) const;

  int width_ = 0, height_ = 0;
  std::vector<Level> levels_;
  std::vector<float> cells_;  ///< level after level, each a quarter of the one before
  std::vector<float> row_;
};

}  // namespace trimtab
