#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/relief.h"

namespace trimtab {

/// A mesh's drawn surface as the horizon reads it, made once a mesh: triangles over a field of posts, any of
/// them.
///
/// What may hide others are sections of the surface along rows and columns of posts: a section runs through
/// triangles from edge to edge, so it lies on the surface all along, wherever its edges are.
struct MeshRelief : Relief {
  /// Triangles that lie together, tried as a box first.
  struct Part {
    Box box;
    std::uint32_t firstVertex = 0, firstCorner = 0;
    std::uint8_t vertices = 0, triangles = 0;
    std::uint8_t peak = 0;  ///< its highest vertex
  };
  static constexpr std::size_t kPartTriangles = 24;
  /// Rise over run: a triangle that is steeper might turn over by a rounding step, and counts as upright.
  static constexpr double kSteepest = 1000;
  static constexpr int kMostCorners = 192;  ///< of a line: a longer one hides nothing

  std::vector<Part> parts;            ///< none where a number is not finite: hides nothing, is never hidden
  std::vector<float> x, y, z;         ///< vertices, part by part
  std::vector<std::uint8_t> corners;  ///< three a triangle, from the part's first vertex
  std::vector<std::uint32_t> lineFirst{0};  ///< where a line begins; one more than lines
  std::vector<float> lineX, lineY, lineZ;
  std::vector<Box> lineBox;  ///< one a line
  float besideM = 0;         ///< no corner of a line is further from the way between its ends, in plan
  float steepest = 0;        ///< rise over run of its triangles, against the frame's z
  /// No triangle stands upright or hangs over in the frame: over each place the mesh has one height.
  bool upright = false;

  std::size_t lines() const { return lineFirst.size() - 1; }
};

/// Position relative to the mesh's origin, and the post that the vertex is.
struct ReliefVertex {
  float x, y, z;
  std::uint16_t column, row;
};

/// `indices`: three a triangle, anticlockwise from above. `step`: posts from one line to the next.
void makeMeshRelief(std::span<const ReliefVertex> vertices, std::span<const std::uint16_t> indices,
                    Vec3 origin, int step, MeshRelief& relief);

}  // namespace trimtab
