#include "lines.h"

#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "trimtab/frame/overlay_colours.h"

namespace trimtab::scene {
namespace {

LineVertex vertex(Vec3 p, Vec3 eye, std::array<std::uint8_t, 3> colour) {
  const Vec3 d = p - eye;
  return {static_cast<float>(d.x),
          static_cast<float>(d.y),
          static_cast<float>(d.z),
          {colour[0], colour[1], colour[2], 255}};
}

}  // namespace

void addBoxes(std::span<const Box> bounds, std::span<const TileDraw> tiles,
              std::span<const CullReason> reason, Vec3 eye, std::vector<LineVertex>& lines) {
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Box& b = bounds[tiles[i].node];
    const auto colour = reasonColour(reason[i]);
    const auto corner = [&](unsigned bits) {
      return vertex({bits & 1u ? b.maxX : b.minX, bits & 2u ? b.maxY : b.minY, bits & 4u ? b.maxZ : b.minZ},
                    eye, colour);
    };
    for (unsigned from = 0; from < 8; ++from)
      for (unsigned axis = 1; axis < 8; axis *= 2)
        if (!(from & axis)) {
          lines.push_back(corner(from));
          lines.push_back(corner(from | axis));
        }
  }
}

void addFrustum(const EyePose& frozen, const ViewShape& view, Vec3 eye, std::vector<LineVertex>& lines) {
  constexpr std::array<std::uint8_t, 3> kColour{240, 228, 66};
  const auto at = [&](double depth, int corner) {
    const double x = corner == 0 || corner == 3 ? view.left : view.right,
                 y = corner < 2 ? view.bottom : view.top;
    const Vec3& right = frozen.axes.row[0];
    return frozen.position + (right * x + frozen.axes.row[1] * y - frozen.axes.row[2]) * depth;
  };
  constexpr std::array<double, 5> kDepths{20, 200, 2000, 20000, 100000};
  for (int corner = 0; corner < 4; ++corner) {
    lines.push_back(vertex(frozen.position, eye, kColour));
    lines.push_back(vertex(at(kDepths.back(), corner), eye, kColour));
    for (const double depth : kDepths) {
      lines.push_back(vertex(at(depth, corner), eye, kColour));
      lines.push_back(vertex(at(depth, (corner + 1) % 4), eye, kColour));
    }
  }
}

LineBuffer::LineBuffer() {
  glGenVertexArrays(1, &vertexArray_);
  glGenBuffers(1, &buffer_);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex), nullptr);
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(LineVertex),
                        reinterpret_cast<const void*>(offsetof(LineVertex, colour)));
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

LineBuffer::~LineBuffer() {
  glDeleteBuffers(1, &buffer_);
  glDeleteVertexArrays(1, &vertexArray_);
}

void LineBuffer::draw(std::span<const LineVertex> lines) {
  if (lines.empty()) return;
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lines.size_bytes()), lines.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glBindVertexArray(vertexArray_);
  glDrawArrays(GL_LINES, 0, static_cast<int>(lines.size()));
  glBindVertexArray(0);
}

}  // namespace trimtab::scene
