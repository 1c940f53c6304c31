#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::terrain {

/// A triangulation of part of a grid of posts, as flat arrays. Places are integers, so that every predicate
/// is exact.
///
/// Half-edge h = 4 t + i leads from corner i of triangle t to its next corner. `twin` is the half-edge on the
/// other side of the edge; on the border it is ~v, where v is the vertex that the border edge leaves.
struct Triangulation {
  struct Vertex {
    std::int32_t x, y;
    float z;
    friend bool operator==(const Vertex&, const Vertex&) = default;
  };
  struct Triangle {
    std::uint32_t corner[3];
    std::int32_t twin[3];
    std::int32_t postX, postY;  ///< for the caller's use: the post to insert next
  };

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> borderEdge;  ///< half-edge that leaves a border vertex along the border

  static constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
  static constexpr int before(int i) { return i == 0 ? 2 : i - 1; }

  /// Returns twice the area of the triangle a, b, (x, y): positive if (x, y) lies left of the line from a to
  /// b.
  static std::int64_t turn(const Vertex& a, const Vertex& b, std::int32_t x, std::int32_t y) {
    return std::int64_t{b.x - a.x} * (y - a.y) - std::int64_t{b.y - a.y} * (x - a.x);
  }
  /// Reports whether d lies inside the circle through a, b, c (anticlockwise). Exact for places that differ
  /// by up to 2^15.
  static bool inCircle(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d);

  /// Makes half-edge h the neighbour of `other`, or of the border where that is negative.
  void link(std::int32_t h, std::int32_t other) {
    triangles[static_cast<std::size_t>(h >> 2)].twin[h & 3] = other;
    if (other >= 0)
      triangles[static_cast<std::size_t>(other >> 2)].twin[other & 3] = h;
    else
      borderEdge[static_cast<std::size_t>(~other)] = h;
  }

  /// Makes Delaunay triangles of the convex polygon whose vertices are `vertices`, anticlockwise. Several may
  /// lie on one side. Every triangle has an area.
  void fillPolygon();
  /// Inserts vertex v, which lies on the border edge that leaves `from`, into the border.
  void splitBorder(std::uint32_t from, std::uint32_t v);
  /// Inserts vertex v, which lies in triangle t or on an edge of it that is not border, and flips edges until
  /// all are Delaunay. Only triangles about v change, and v is corner 2 of each. Returns one of them.
  std::int32_t insert(std::int32_t t, std::uint32_t v);
  /// Flips the edge opposite corner 2 of triangle t. Its two triangles keep their places; corner 2 of t is in
  /// both.
  void flip(std::int32_t t);

 private:
  void legalize();
  std::vector<std::int32_t> stack_;
};

}  // namespace trimtab::terrain
