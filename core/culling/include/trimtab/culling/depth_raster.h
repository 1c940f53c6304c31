#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"

/// The inner loops of depth_map.h: eight lanes at a time, compiled for what the processor has. The same
/// operations in the same order at every level, none of them fused: the maps are equal to the bit.
namespace trimtab::depth {

constexpr std::size_t kLanes = 8;

/// Three corners a triangle, eight triangles a group: first corners, second corners, third corners. What
/// fills the last group up is degenerate.
class Triangles {
 public:
  Triangles() = default;
  /// `indices`: three a triangle.
  explicit Triangles(std::span<const std::uint16_t> indices);
  std::size_t groups() const { return corners_.size() / (3 * kLanes); }
  const std::uint16_t* group(std::size_t i) const { return corners_.data() + i * 3 * kLanes; }
  std::size_t count() const { return count_; }

 private:
  std::vector<std::uint16_t> corners_;
  std::size_t count_ = 0;
};

/// Vertices from an origin, and how steep the surface is near each.
struct Vertices {
  const float *x, *y, *z, *slope;
  std::size_t count;  ///< the arrays are as long as whole groups of kLanes are
};

/// How vertices are seen, and by how much they are lowered: see depth_map.h.
struct Projection {
  std::array<float, 3> offset{};  ///< the vertices' origin from the eye
  std::array<float, 3> right{}, up{}, forward{};
  float nearM = 0;
  float scaleX = 0, scaleY = 0, left = 0, bottom = 0;  ///< texel = tangent * scale + left or bottom
  std::array<float, 2> down{}, aside{};  ///< of the two diagonals of what a sample stands for, at depth 1
  float lowering = 1;
  // Of the mesh.
  float reach = 0, farReach = 0, farSlope = 0, edge = 0, tilt = 0;
};

/// What lies beyond is cut off before it is drawn.
constexpr float kGuard = 16384;

/// Vertices as seen: texels, and near / depth. Where `kept` is not 0, x is not a number: of the triangles
/// there those with kClip only may be drawn after clipping.
struct Seen {
  static constexpr std::uint8_t kClip = 1, kDropped = 2;
  std::vector<float> x, y, w;
  std::vector<float> right, up, depth;  ///< metres, lowered
  std::vector<std::uint8_t> kept;
  bool anyKept = false;
  void resize(std::size_t count);
};

/// Texels as near / depth, row 0 at the bottom. Rows are as long as `strideOf`, and kRowsBeyond more than
/// `height`: what is written there is of no meaning.
constexpr int kRowsBeyond = 4;
constexpr int strideOf(int width) {
  return (width + 15) / 16 * 16;
}
struct Texels {
  float* first = nullptr;
  int stride = 0, width = 0, height = 0;
};
/// Texels that may have been changed: x0..x1, y0..y1, none where x0 > x1.
struct Touched {
  int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1;
};

/// Rectangles that boxes cover, texels, and near / distance of their nearest points. `x0` is kInFront where a
/// box reaches the near plane or is not of numbers, kOutside where it is outside the view.
struct Rectangles {
  static constexpr std::int32_t kInFront = -1, kOutside = -2;
  std::array<std::int32_t, kLanes> x0, y0, x1, y1;
  std::array<float, kLanes> limit;
};
/// Eight boxes, from the mesh's origin.
struct Boxes {
  const float* low[3];
  const float* high[3];
};
/// Of the map's view: the projection's, and how much wider than what it covers a box is taken, texels.
struct BoxView {
  int width = 0, height = 0;
  float padX = 0, padY = 0;
  bool whole = false;  ///< a box that is not wholly in the view counts as in front
};

void project(const Projection& projection, const Vertices& vertices, Seen& seen, SimdLevel level);
/// `first`..: groups of triangles; those with a vertex that is `kept` are left out.
void draw(const Texels& to, const Seen& seen, const Triangles& triangles, Touched& touched, SimdLevel level);
void rectangles(const Projection& projection, const BoxView& view, const Boxes& boxes, Rectangles& out,
                SimdLevel level);

}  // namespace trimtab::depth
