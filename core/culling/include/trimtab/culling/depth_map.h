#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/culling/depth_raster.h"
#include "trimtab/frame/eye_pose.h"

/// The ground's depth map as the CPU draws it, and what lies behind it.
///
/// The proof. S is the terrain as drawn this frame: continuous over its footprint, one height over each place
/// (by the frame's z), its slope near a place at most L (DepthMesh says how near). The eye E is above S,
/// further than the near plane's corners. What is drawn into the map is a surface D that lies below S, and a
/// texel keeps the nearest depth of D along the ray through its centre.
///
/// Only rays through the centres of the picture's pixels matter. Let such a ray r go through a texel, off its
/// centre by at most a sideways and b upwards, at depth 1. Let D be met by the centre's ray at P, at depth z,
/// and let Q be the point of r at that depth: Q - P = z (x right + y up) with |x| <= a, |y| <= b. S under Q
/// is at most L |Q - P|' below S over P, where ' is seen in plan. So Q is not above S if D lies below S by at
/// least the largest (Q - P).z + L |Q - P|', which is at a corner of that rectangle, as it is convex:
/// z max(|c.z| + L |c|') over its two diagonals c. That is by how much each vertex is lowered; the need grows
/// in proportion to the depth, so between vertices it is met too. E is above S and Q is not: r meets S
/// between them, at depth z or less, and beyond the near plane. So behind the depth that a texel shows, no
/// pixel of the texel sees anything.
///
/// A mesh is hidden when each texel that its parts' boxes touch shows a depth nearer than the box: each
/// fragment of it would fail against one that is drawn, whose own mesh is never hidden, since one of its
/// boxes is at that texel and not behind.
///
/// Rounding. Vertices in texels are off by less than 0.003 (they are within kGuard of the view), which moves
/// the sample and not the depth: a and b are enlarged by 0.02 texels, and by a tenth of a pixel for the
/// picture's own snapping. A sample may be taken for inside an edge from which it is as far outside: depths
/// are put farther by what they change in 1/64 texel. A plane through three vertices, evaluated in single
/// precision, is off by less than 2^-20 k (1 + k) of its depths' range, where k is the area of its box over
/// twice its own: put farther by that too, and never nearer or farther than its vertices. So edge-on
/// triangles count as their farthest vertex, and what is no triangle as nothing.
namespace trimtab {

/// A mesh that may hide others, and what must be hidden for it to be left out.
struct DepthMesh {
  Vec3 origin;  ///< of all that follows, metres, local frame
  /// No point of the triangles between these is above the surface as drawn. Longer than `vertices`: the last
  /// is repeated to the end of a group of depth::kLanes.
  std::vector<float> x, y, z;
  /// Bounds the slope of the surface as drawn (rise over run against the geodetic vertical) under the
  /// triangles of a vertex and for `reach` around them.
  std::vector<float> slope;
  std::size_t vertices = 0;
  float reach = 0;                   ///< metres
  float farReach = 0, farSlope = 0;  ///< the same for all vertices at once, and further
  float edge = 0;                    ///< a triangle's longest edge, seen from above

  /// Boxes that together hold all that is drawn of it, as long as whole groups of depth::kLanes are: low x,
  /// y, z, high x, y, z. The first group is the whole mesh, in each lane.
  std::array<std::vector<float>, 6> boxes;
  void setBoxes(std::span<const Box> parts);
  void setVertex(std::size_t i, float vx, float vy, float vz, float vslope) {
    x[i] = vx, y[i] = vy, z[i] = vz, slope[i] = vslope;
  }
  void setVertices(std::size_t count);
  /// Repeats the last vertex; once all are set.
  void finishVertices();
};

enum class DepthFate : std::uint8_t { seen = 0, hidden = 1, outside = 2 };

/// Where a mesh's boxes are in a map's view, and whether a pyramid covers them.
class DepthTest {
 public:
  void begin(const EyePose& eye, const ViewShape& view, int width, int height, SimdLevel level);
  DepthFate operator()(const DepthMesh& mesh, const DepthPyramid& pyramid) const;
  /// Of the whole mesh's box: false where it reaches the near plane, or is outside.
  struct Rectangle {
    int x0, y0, x1, y1;
    float limit;
  };
  DepthFate rectangle(const DepthMesh& mesh, Rectangle& out) const;

 private:
  friend class DepthMap;
  depth::Projection at(Vec3 origin) const;

  Vec3 eye_;
  depth::Projection projection_;
  depth::BoxView view_;
  SimdLevel level_ = SimdLevel::portable;
};

class DepthMap {
 public:
  struct Settings {
    int width = 320, height = 240;
    double lowering = 1;  ///< of what the proof asks for; less is wrong: for tests that see it fail
    SimdLevel level = simdLevel();
  };
  /// An empty map. An eye or a view that is not of numbers covers nothing.
  void begin(const EyePose& eye, const ViewShape& view, const Settings& settings);
  /// Draws it in, unless it is outside the view or wholly behind what is drawn so far: nearest ones first.
  DepthFate draw(const DepthMesh& mesh, const depth::Triangles& triangles);
  /// Completes the pyramid.
  void finish();
  /// After `finish`.
  DepthFate test(const DepthMesh& mesh) const { return test_(mesh, pyramid_); }
  const DepthPyramid& pyramid() const { return pyramid_; }
  std::uint64_t triangles() const { return triangles_; }  ///< of the meshes drawn in since `begin`

 private:
  bool covers(const DepthTest::Rectangle& r);
  void drawClipped(const depth::Triangles& triangles, depth::Touched& touched);
  void touch(const depth::Touched& touched);

  DepthTest test_;
  Settings settings_;
  double nearM_ = 1;
  std::array<float, 2> down_{}, aside_{};
  depth::Texels texels_;
  std::vector<float> cells_;
  depth::Seen seen_, clipped_;
  /// The farthest texel of each square of kBlock texels, found when it is asked for.
  static constexpr int kBlock = 8;
  int blocksAcross_ = 0;
  std::vector<float> farthest_;
  DepthPyramid pyramid_;
  std::uint64_t triangles_ = 0;
  struct {
    int map = 0, picture = 0;
    double off = 0;
  } across_, upwards_;  ///< how far the picture's pixels are from the centres of the map's texels
};

}  // namespace trimtab
