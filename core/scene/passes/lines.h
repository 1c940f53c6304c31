#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

struct LineVertex {
  float x, y, z;  ///< relative to the eye, local axes
  std::array<std::uint8_t, 4> colour;
};

/// Boxes of the tiles, as pairs of points; a reason a tile.
void addBoxes(std::span<const Box> bounds, std::span<const TileDraw> tiles,
              std::span<const CullReason> reason, Vec3 eye, std::vector<LineVertex>& lines);
/// Edges of a view pyramid that stands at `frozen`, seen from `eye`.
void addFrustum(const EyePose& frozen, const ViewShape& view, Vec3 eye, std::vector<LineVertex>& lines);

/// Lines on the GPU. The context is current; a program that reads attributes 0 position and 3 colour is in
/// use.
class LineBuffer {
 public:
  LineBuffer();
  ~LineBuffer();
  LineBuffer(const LineBuffer&) = delete;
  LineBuffer& operator=(const LineBuffer&) = delete;
  void draw(std::span<const LineVertex> lines);

 private:
  unsigned vertexArray_ = 0, buffer_ = 0;
};

}  // namespace trimtab::scene
