#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"

/// The inner loops of depth_map.h, which work on eight lanes at a time and are compiled for each SIMD level.
/// Every level does the same operations in the same order, none of them fused, so the maps are equal to the
/// bit.
namespace trimtab::depth {

constexpr std::size_t kLanes = 8;

/// The corners of triangles in groups of eight: eight first corners, eight second corners, eight third
/// corners. Degenerate triangles pad the last group.
class Triangles {
 public:
  Triangles() = default;
  /// `indices` has three entries per triangle.
  explicit Triangles(std::span<const std::uint16_t> indices);
  std::size_t groups() const { return corners_.size() / (3 * kLanes); }
  const std::uint16_t* group(std::size_t i) const { return corners_.data() + i * 3 * kLanes; }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint16_t> corners_;
  std::size_t count_ = 0;
};

/// Vertices relative to an origin, metres, and the slope bound near each.
struct Vertices {
  const float *x, *y, *z, *slope;
  std::size_t count;  ///< the arrays are padded to whole groups of kLanes
};

/// How vertices are projected, and by how much they are lowered (depth_map.h).
struct Projection {
  std::array<float, 3> offset{};  ///< the vertices' origin relative to the eye
  std::array<float, 3> right{}, up{}, forward{};
  float nearM = 0;
  float scaleX = 0, scaleY = 0, left = 0, bottom = 0;  ///< texel = tangent * scale + left or bottom
  /// Vertical and horizontal extent of the two diagonals of the area that one sample stands for, at depth 1.
  std::array<float, 2> down{}, aside{};
  float lowering = 1;  ///< DepthMap::Settings
  // The fields of DepthMesh, and how far its verticals lean from the frame's z (rise over run).
  float reach = 0, farReach = 0, farSlope = 0, edge = 0, tilt = 0;
};

/// Vertices further than this outside the map, in texels, are clipped before drawing.
constexpr float kGuard = 16384;

/// Projected vertices: x and y in texels, w = near / depth. If `kept` is not 0, x is not a number, and a
/// triangle at that vertex may be drawn only after clipping, and only if none of its vertices is kDropped.
struct Seen {
  static constexpr std::uint8_t kClip = 1, kDropped = 2;
  std::vector<float> x, y, w;
  std::vector<float> right, up, depth;  ///< metres, lowered
  std::vector<std::uint8_t> kept;
  bool anyKept = false;
  void resize(std::size_t count);
};

/// Texels that hold near / depth, with row 0 at the bottom. Rows are strideOf(width) long and there are
/// kRowsBeyond more than `height`; what is written in this padding means nothing.
constexpr int kRowsBeyond = 4;
constexpr int strideOf(int width) {
  return (width + 15) / 16 * 16;
}
struct Texels {
  float* first = nullptr;
  int stride = 0, width = 0, height = 0;
};
/// The texels x0..x1, y0..y1 that drawing may have changed; none if x0 > x1.
struct Touched {
  int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1;
};

/// Rectangles of texels that boxes cover, and near / distance of the boxes' nearest points. x0 is kInFront if
/// a box reaches the near plane or holds anything that is not a number, and kOutside if it is outside the
/// view.
struct Rectangles {
  static constexpr std::int32_t kInFront = -1, kOutside = -2;
  std::array<std::int32_t, kLanes> x0, y0, x1, y1;
  std::array<float, kLanes> limit;
};
/// Eight boxes, relative to the mesh's origin.
struct Boxes {
  const float* low[3];
  const float* high[3];
};
/// The map's size, and by how many texels boxes are widened before the test.
struct BoxView {
  int width = 0, height = 0;
  float padX = 0, padY = 0;
};

void project(const Projection& projection, const Vertices& vertices, Seen& seen, SimdLevel level);
/// Draws triangles into the map, except those that have a vertex with `kept` not 0.
void draw(const Texels& to, const Seen& seen, const Triangles& triangles, Touched& touched, SimdLevel level);
void rectangles(const Projection& projection, const BoxView& view, const Boxes& boxes, Rectangles& out,
                SimdLevel level);

}  // namespace trimtab::depth
