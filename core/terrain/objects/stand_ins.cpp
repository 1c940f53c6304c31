#include "stand_ins.h"

#include <algorithm>
#include <initializer_list>

#include "checked_mesh.h"

namespace trimtab::terrain {

namespace {

using Place = std::array<float, 3>;

struct Bounds {
  Place low, high;
};

Bounds boundsOf(const SourceMesh& mesh) {
  Bounds b{mesh.vertices[0].position, mesh.vertices[0].position};
  for (const SourceVertex& v : mesh.vertices)
    for (std::size_t i = 0; i < 3; ++i) {
      b.low[i] = std::min(b.low[i], v.position[i]);
      b.high[i] = std::max(b.high[i], v.position[i]);
    }
  return b;
}

/// Collects triangles of one colour.
class Shape {
 public:
  Shape(const std::array<std::uint8_t, 4>& colour, bool bothSides) : colour_(colour) {
    mesh_.bothSides = bothSides;
  }
  /// Corners anticlockwise from outside. Without a normal the face's is used.
  Shape& face(std::initializer_list<Place> corners, Place normal = {}) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Place& corner : corners)
      mesh_.vertices.push_back({corner, normal, colour_, {}, SourceVertex::kNoTexture});
    for (std::uint32_t k = 2; k < corners.size(); ++k)
      mesh_.indices.insert(mesh_.indices.end(), {first, first + k - 1, first + k});
    return *this;
  }
  SourceMesh mesh() const {
    MeshFaults none;
    return checkedMesh(mesh_, 0, none);
  }

 private:
  std::array<std::uint8_t, 4> colour_;
  SourceMesh mesh_;
};

SourceMesh box(const Bounds& b, const std::array<std::uint8_t, 4>& colour, bool bottom) {
  const auto& [l, h] = b;
  Shape shape(colour, false);
  shape.face({{l[0], l[1], l[2]}, {h[0], l[1], l[2]}, {h[0], l[1], h[2]}, {l[0], l[1], h[2]}})
      .face({{h[0], l[1], l[2]}, {h[0], h[1], l[2]}, {h[0], h[1], h[2]}, {h[0], l[1], h[2]}})
      .face({{h[0], h[1], l[2]}, {l[0], h[1], l[2]}, {l[0], h[1], h[2]}, {h[0], h[1], h[2]}})
      .face({{l[0], h[1], l[2]}, {l[0], l[1], l[2]}, {l[0], l[1], h[2]}, {l[0], h[1], h[2]}})
      .face({{l[0], l[1], h[2]}, {h[0], l[1], h[2]}, {h[0], h[1], h[2]}, {l[0], h[1], h[2]}});
  if (bottom) shape.face({{l[0], h[1], l[2]}, {h[0], h[1], l[2]}, {h[0], l[1], l[2]}, {l[0], l[1], l[2]}});
  return shape.mesh();
}

/// Sides from a rectangle at the height `base` to a tip, above or below it.
void pyramidSides(Shape& shape, const Bounds& b, float base, Place tip) {
  const auto& [l, h] = b;
  const Place corner[4] = {{l[0], l[1], base}, {h[0], l[1], base}, {h[0], h[1], base}, {l[0], h[1], base}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Place &from = corner[i], &to = corner[(i + 1) % 4];
    if (tip[2] >= base)
      shape.face({from, to, tip});
    else
      shape.face({to, from, tip});
  }
}

}  // namespace

std::vector<SourceMesh> standIns(const SourceMesh& mesh, const std::array<std::uint8_t, 4>& colour) {
  const Bounds b = boundsOf(mesh);
  const auto& [l, h] = b;
  for (std::size_t i = 0; i < 3; ++i)
    if (!(h[i] > l[i])) return {};
  const float x = (l[0] + h[0]) / 2, y = (l[1] + h[1]) / 2, z = (l[2] + h[2]) / 2;
  const Place up{0, 0, 1};
  std::vector<SourceMesh> all{box(b, colour, true), box(b, colour, false)};
  Shape pyramid(colour, false), twoPyramids(colour, false);
  pyramidSides(pyramid, b, l[2], {x, y, h[2]});
  pyramidSides(twoPyramids, b, z, {x, y, h[2]});
  pyramidSides(twoPyramids, b, z, {x, y, l[2]});
  all.push_back(pyramid.mesh());
  all.push_back(twoPyramids.mesh());
  all.push_back(Shape(colour, true)
                    .face({{l[0], y, l[2]}, {h[0], y, l[2]}, {h[0], y, h[2]}, {l[0], y, h[2]}}, up)
                    .face({{x, l[1], l[2]}, {x, h[1], l[2]}, {x, h[1], h[2]}, {x, l[1], h[2]}}, up)
                    .mesh());
  all.push_back(Shape(colour, true)
                    .face({{l[0], y, l[2]}, {h[0], y, l[2]}, {x, y, h[2]}}, up)
                    .face({{x, l[1], l[2]}, {x, h[1], l[2]}, {x, y, h[2]}}, up)
                    .mesh());
  return all;
}

}  // namespace trimtab::terrain
