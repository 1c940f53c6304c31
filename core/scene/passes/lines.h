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

/// Appends the edges of the tiles' boxes as pairs of points, in the colour of each tile's reason.
void addBoxes(std::span<const Box> bounds, std::span<const TileDraw> tiles,
              std::span<const CullReason> reason, Vec3 eye, std::vector<LineVertex>& lines);
/// Appends the edges of the view pyramid at `frozen`, seen from `eye`.
void addFrustum(const EyePose& frozen, const ViewShape& view, Vec3 eye, std::vector<LineVertex>& lines);

/// Draws lines. The context must be current, with a program in use that reads attributes 0 position and 3
/// colour.
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
