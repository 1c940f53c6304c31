#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_place.h"

/// Triangles from height posts: greedy insertion of the post that is furthest off, in a Delaunay mesh.
///
/// Flat arrays; the same input gives the same mesh on any machine and number of cores.
namespace trimtab::terrain {

/// Posts in memory; `z` may be any height, with the earth's curvature in it where that counts. All are
/// finite: voids are filled before (voids.h), as no error says anything of a post without a height.
struct HeightField {
  const float* z = nullptr;
  std::uint32_t columns = 0, rows = 0;
  std::size_t stride = 0;  ///< posts from a row to the next
  std::uint32_t step = 1;  ///< of the places of meshes: post (column, row) lies at step times that
  float at(std::uint32_t column, std::uint32_t row) const { return z[row * stride + column]; }
};

struct MeshVertex {
  std::uint32_t column, row;
  float z;  ///< of the post, or fitted
};

/// Triangles that cover the field once, anticlockwise from above.
struct FieldMesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle
  double maxErrorM = 0;                ///< largest vertical distance at a post: measured, no post is worse
  double rmsErrorM = 0;                ///< at the posts
  std::size_t triangles() const { return indices.size() / 3; }
};

struct MeshOptions {
  double maxErrorM = 0;           ///< insertion ends where no post is further off; 0: every post counts
  std::size_t mostTriangles = 0;  ///< or at so many, two at the least; 0: no limit
  /// Flips edges and moves vertices for a smaller RMS; of a limit's triangles, takes out and puts in, where
  /// they are coarse also for a smaller largest error. The bound is kept.
  bool fitHeights = true;
  unsigned threads = 1;
};

/// A mesh of a whole field, by tiles whose borders are simplified once.
FieldMesh meshField(const HeightField& field, const MeshOptions& options);

/// A convex polygon of posts with a border that must not change, and meshes of falling error inside it. Keeps
/// its storage from polygon to polygon.
class PolygonMesher {
 public:
  using Point = PostPlace;
  PolygonMesher();
  ~PolygonMesher();
  PolygonMesher(PolygonMesher&&) noexcept;
  PolygonMesher& operator=(PolygonMesher&&) noexcept;

  /// Begins anew. `border`: anticlockwise, every vertex of the polylines all round; neighbours in it may lie
  /// on one line, but the polygon has an area. Points within the field. `borderZ`: their heights, where they
  /// need not be those of posts; only then a border vertex may lie between posts.
  void begin(const HeightField& field, std::span<const Point> border, std::span<const float> borderZ = {});
  /// Inserts posts until none inside is further off than `tolerance`, or `mostVertices` are there. What was
  /// inserted before stays: vertices of a coarser mesh are the first of a finer one.
  void refine(double tolerance, std::size_t mostVertices);

  const std::vector<Point>& vertices() const;  ///< the border's first, as given
  /// Of now: three a triangle, anticlockwise. `twins`: of its edges, the first from its first corner, the
  /// half-edges on the other side, edge i of triangle t as 4 t + i; negative at the border.
  void triangles(std::vector<std::uint32_t>& indices, std::vector<std::int32_t>* twins = nullptr) const;
  double maxErrorM() const;  ///< at the posts inside and on the border
  double rmsErrorM() const;
  std::uint32_t posts() const;  ///< that these were measured at

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A side of a polygon from one post to another, both kept, along a row, a column or a diagonal: the posts
/// between that keep all others within `tolerance`. The same from either end: it is simplified from the
/// lesser (row, then column).
void simplifySide(const HeightField& field, PolygonMesher::Point from, PolygonMesher::Point to,
                  double tolerance, std::vector<PolygonMesher::Point>& polyline);

}  // namespace trimtab::terrain
