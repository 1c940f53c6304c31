#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/relief.h"

namespace trimtab {

/// A mesh's drawn surface in the form that the horizon reads: any triangles over a field of posts. It is made
/// once per mesh.
///
/// Its lines, which may hide others, are sections of the surface along rows and columns of posts. A section
/// runs through triangles from edge to edge, so it lies on the surface wherever the edges are.
struct MeshRelief : Relief {
  /// A group of adjacent triangles, which is tested as a box first.
  struct Part {
    Box box;
    std::uint32_t firstVertex = 0, firstCorner = 0;
    std::uint8_t vertices = 0, triangles = 0;
    std::uint8_t peak = 0;  ///< its highest vertex
  };
  static constexpr std::size_t kPartTriangles = 24;
  /// Rise over run. A steeper triangle might turn over by rounding, so it counts as standing upright.
  static constexpr double kSteepest = 1000;
  static constexpr int kMostCorners = 192;  ///< a line with more corners hides nothing

  std::vector<Part> parts;                  ///< empty if a number is not finite: hides nothing, never hidden
  std::vector<float> x, y, z;               ///< vertices, part by part
  std::vector<std::uint8_t> corners;        ///< three per triangle, relative to the part's first vertex
  std::vector<std::uint32_t> lineFirst{0};  ///< first corner of each line, and the end
  std::vector<float> lineX, lineY, lineZ;
  std::vector<Box> lineBox;  ///< one per line
  float besideM = 0;   ///< furthest that a line's corner lies beside the chord of the line in plan, metres
  float steepest = 0;  ///< largest rise over run of a triangle, against the frame's z
  /// True if no triangle stands upright or overhangs in the frame, so that each place has one height.
  bool upright = false;

  std::size_t lines() const { return lineFirst.size() - 1; }
};

/// A vertex: its position relative to the mesh's origin, metres, and the post that it is.
struct ReliefVertex {
  float x, y, z;
  std::uint16_t column, row;
};

/// Fills `relief`. `indices` has three entries per triangle, anticlockwise from above; `step` is the number
/// of posts from one line to the next.
void makeMeshRelief(std::span<const ReliefVertex> vertices, std::span<const std::uint16_t> indices,
                    Vec3 origin, int step, MeshRelief& relief);

}  // namespace trimtab
