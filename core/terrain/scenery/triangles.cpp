#include "triangles.h"

#include <algorithm>
#include <utility>

namespace trimtab::terrain {

void tidyTriangles(SceneryMesh& mesh) {
  const std::vector<Vec3>& v = mesh.vertices;
  std::vector<SceneryMesh::Triangle>& all = mesh.triangles;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [a, b, c] = all[i].vertex;
    if (v[a] == v[b] || v[b] == v[c] || v[c] == v[a]) continue;
    if (!mesh.texture.empty()) mesh.texture[kept] = mesh.texture[i];
    all[kept++] = all[i];
  }
  mesh.degenerate += all.size() - kept;
  all.resize(kept);
  if (!mesh.texture.empty()) mesh.texture.resize(kept);
  double up = 0, down = 0;
  std::uint64_t facingUp = 0;
  for (const SceneryMesh::Triangle& t : all) {
    const auto [a, b, c] = t.vertex;
    // Up is along the ellipsoid's normal, not the line to its centre.
    const Vec3 normal{v[a].x, v[a].y, v[a].z * 1.00673949674228};
    const double area = dot(cross(v[b] - v[a], v[c] - v[a]), normal);
    if (area < 0) {
      down -= area;
      ++mesh.facingDown;
    } else {
      up += area;
      ++facingUp;
    }
  }
  if (down <= up) return;
  for (SceneryMesh::Triangle& t : all) std::swap(t.vertex[1], t.vertex[2]);
  for (TextureCorners& corners : mesh.texture) std::swap(corners[1], corners[2]);
  mesh.facingDown = facingUp;
}

}  // namespace trimtab::terrain
