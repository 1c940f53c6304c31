#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_place.h"

/// Makes triangles from height posts by greedy insertion: the post with the worst error becomes the next
/// vertex of a Delaunay mesh. The same input gives the same mesh, to the bit, on every machine.
/// resources/docs/mesher.md explains the method.
namespace trimtab::terrain {

/// A view of posts in memory. The heights are metres in any frame and all finite: voids have been filled
/// (voids.h).
struct HeightField {
  const float* z = nullptr;
  std::uint32_t columns = 0, rows = 0;
  std::size_t stride = 0;  ///< posts from one row to the next
  std::uint32_t step = 1;  ///< post (column, row) lies at the place (step * column, step * row)
  float at(std::uint32_t column, std::uint32_t row) const { return z[row * stride + column]; }
};

/// Meshes a convex polygon of posts whose border must not change, more and more finely. Keeps its storage
/// from polygon to polygon.
class PolygonMesher {
 public:
  using Point = PostPlace;
  PolygonMesher();
  ~PolygonMesher();

  /// Begins a new polygon. `border` lists all vertices of its outline anticlockwise, at places within the
  /// field. Neighbours may lie on one line, but the polygon has an area. `borderZ` are their heights; without
  /// it they are those of the posts. Only with it may a border vertex lie between posts. The field must
  /// outlive the polygon.
  void begin(const HeightField& field, std::span<const Point> border, std::span<const float> borderZ = {});
  /// Inserts posts until no post inside is farther than `tolerance` metres from the mesh, or until there are
  /// `mostVertices` vertices. Earlier vertices stay: those of a coarser mesh are the first of a finer one.
  void refine(double tolerance, std::size_t mostVertices);

  const std::vector<Point>& vertices() const;  ///< the border's first, as given
  /// Fills `indices` with the mesh as it is now, three vertices per triangle, anticlockwise. Fills `twins`,
  /// if given, with the half-edge on the other side of each edge, three per triangle, the edge that leaves
  /// its first corner first. Edge i of triangle t is half-edge 4 t + i; a border edge has a negative twin.
  void triangles(std::vector<std::uint32_t>& indices, std::vector<std::int32_t>* twins = nullptr) const;
  double maxErrorM() const;     ///< worst vertical error at the posts inside and on the border
  double rmsErrorM() const;     ///< at the same posts
  std::uint32_t posts() const;  ///< how many posts these are

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Simplifies the side of a polygon from one post to another along a row, a column or a diagonal. Fills
/// `polyline` with `from`, the posts that keep all others within `tolerance` metres, and `to`. It is the same
/// line from either end, because it is always computed from the lesser end (by row, then column).
void simplifySide(const HeightField& field, PolygonMesher::Point from, PolygonMesher::Point to,
                  double tolerance, std::vector<PolygonMesher::Point>& polyline);

}  // namespace trimtab::terrain
