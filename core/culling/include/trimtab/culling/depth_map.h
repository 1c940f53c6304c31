#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/culling/depth_raster.h"
#include "trimtab/frame/eye_pose.h"

/// A depth map of the ground that the CPU draws, and the test of what lies behind it.
///
/// What is drawn into the map lies below the surface as drawn, by so much that no pixel of a texel sees
/// anything behind the depth that the texel shows. resources/docs/occlusion.md derives by how much vertices
/// are lowered, and the margins for rounding. The proof needs three conditions, which OcclusionConditions
/// checks: the surface has one height over each place, has no cracks, and the eye is above it by more than
/// the near plane's corners.
///
/// The traps: DepthMesh::slope must bound the drawn surface's slope for `reach` around each triangle, and
/// draw() must be called for the nearest meshes first, or little is skipped. Everything in this file is
/// confined to one thread; different DepthMap objects are independent.
namespace trimtab {

/// A mesh that may hide others, and the boxes that must be hidden before the mesh itself may be left out.
struct DepthMesh {
  Vec3 origin;  ///< metres, local frame; all other coordinates are relative to it
  /// No point of the triangles between these vertices is above the surface as drawn. The arrays are padded to
  /// whole groups of depth::kLanes with copies of the last vertex.
  std::vector<float> x, y, z;
  /// Upper bound of the drawn surface's slope (rise over run against the geodetic vertical) under the
  /// triangles of a vertex and within `reach` of them.
  std::vector<float> slope;
  std::size_t vertices = 0;
  float reach = 0;                   ///< metres
  float farReach = 0, farSlope = 0;  ///< a larger reach, and the slope bound for all vertices within it
  float edge = 0;                    ///< longest edge of any triangle in plan, metres

  /// Boxes that together contain everything drawn of the mesh: low x, y, z, high x, y, z. Padded to whole
  /// groups of depth::kLanes; every lane of the first group holds the box of the whole mesh.
  std::array<std::vector<float>, 6> boxes;
  void setBoxes(std::span<const Box> parts);
  void setVertex(std::size_t i, float vx, float vy, float vz, float vslope) {
    x[i] = vx, y[i] = vy, z[i] = vz, slope[i] = vslope;
  }
  void setVertices(std::size_t count);
  /// Pads the arrays. Call it after the last setVertex.
  void finishVertices();
};

enum class DepthFate : std::uint8_t { seen = 0, hidden = 1, outside = 2 };

class DepthMap {
 public:
  struct Settings {
    int width = 320, height = 240;
    double lowering = 1;  ///< factor on the lowering that the proof asks for; tests set less to see it fail
    SimdLevel level = simdLevel();
  };
  /// Clears the map for a view. If the eye or the view holds anything that is not a number, nothing is
  /// covered.
  void begin(const EyePose& eye, const ViewShape& view, const Settings& settings);
  /// Draws a mesh unless it is outside the view or wholly behind what is drawn so far, and returns which.
  /// Call it for the nearest meshes first.
  DepthFate draw(const DepthMesh& mesh, const depth::Triangles& triangles);
  /// Builds the pyramid that `test` reads.
  void finish();
  /// Returns whether a mesh is hidden, outside the view, or possibly seen. Call it after `finish`.
  DepthFate test(const DepthMesh& mesh) const;
  const DepthPyramid& pyramid() const { return pyramid_; }
  std::uint64_t triangles() const { return triangles_; }  ///< in the meshes drawn since `begin`

 private:
  /// Texels that a box covers, and near / distance of its nearest point.
  struct Rectangle {
    int x0, y0, x1, y1;
    float limit;
  };
  /// Returns the rectangles of eight of a mesh's boxes, from `first` on.
  depth::Rectangles rectangles(const depth::Projection& projection, const DepthMesh& mesh,
                               std::size_t first) const;
  void setProjection(const EyePose& eye, const ViewShape& view);
  depth::Projection projectionAt(Vec3 origin) const;
  bool covers(const Rectangle& r);
  void drawClipped(const depth::Triangles& triangles, depth::Touched& touched);
  void touch(const depth::Touched& touched);

  Settings settings_;
  Vec3 eye_;
  depth::Projection projection_;
  depth::BoxView view_;
  double nearM_ = 1;
  std::array<float, 2> down_{}, aside_{};
  depth::Texels texels_;
  std::vector<float> cells_;
  depth::Seen seen_, clipped_;
  /// The farthest depth of each square of kBlock texels; negative until it is asked for.
  static constexpr int kBlock = 8;
  int blocksAcross_ = 0;
  std::vector<float> farthest_;
  DepthPyramid pyramid_;
  std::uint64_t triangles_ = 0;
  struct {
    int map = 0, picture = 0;
    double off = 0;
  } across_, upwards_;  ///< the farthest that a pixel of the image is from the centre of its texel, in texels
};

}  // namespace trimtab
