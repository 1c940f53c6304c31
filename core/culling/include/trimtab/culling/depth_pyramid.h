#pragma once

#include <array>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab {

/// Distances at which everything in a part of the picture is covered, and what lies behind them.
///
/// The map has one depth a texel: near / view depth of the *farthest* of all pixels of the picture that the
/// texel touches, 0 where a pixel is uncovered. So it needs nothing of the surface that covers: holes, steep
/// walls and an eye at any place leave farther depths, or none. A box is hidden when each texel that its
/// projection touches, and a pixel's width around, shows a depth nearer than the box's nearest point: each
/// fragment of what lies in it would fail the depth test against what the pixel has already.
class DepthPyramid {
 public:
  /// Row 0 at the bottom, `stride` entries from row to row (0: width). What is no number counts as uncovered.
  void build(std::span<const float> depths, int width, int height, int stride = 0);
  /// The map of a picture of any size: the farthest pixel that each texel touches.
  void buildFromPicture(std::span<const float> picture, int pictureWidth, int pictureHeight, int width,
                        int height);

  /// False unless proven; false for a box that reaches the near plane. Margins cover float rounding in the
  /// picture. `view` has the picture's size, which need not be a multiple of the map's.
  bool isHidden(const Box& box, const EyePose& eye, const ViewShape& view) const;
  /// Whether each texel from (x0, y0) to (x1, y1), which are in the map, is nearer than `limit`, near over
  /// depth. From coarse to fine, so that it ends where the answer is known.
  bool covers(int x0, int y0, int x1, int y1, float limit) const;

  int width() const { return width_; }
  int height() const { return height_; }
  /// As given to `build`.
  std::span<const float> depths() const;

 private:
  struct Level {
    std::size_t first = 0;
    int width = 0, height = 0;
  };
  void resize(int width, int height);
  void reduce();
  bool coversWithin(std::size_t level, int x0, int y0, int x1, int y1, float limit) const;

  int width_ = 0, height_ = 0;
  std::vector<Level> levels_;
  std::vector<float> cells_;  ///< level after level, each a quarter of the one before
  std::vector<float> row_;
};

}  // namespace trimtab
