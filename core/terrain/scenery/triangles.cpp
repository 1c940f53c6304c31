#include "triangles.h"

#include <algorithm>
#include <utility>

namespace trimtab::terrain {

void tidyTriangles(SceneryMesh& mesh) {
  const std::vector<Vec3>& v = mesh.vertices;
  std::vector<SceneryMesh::Triangle>& all = mesh.triangles;
  const auto kept = std::remove_if(all.begin(), all.end(), [&](const SceneryMesh::Triangle& t) {
    const auto [a, b, c] = t.vertex;
    return v[a] == v[b] || v[b] == v[c] || v[c] == v[a];
  });
  mesh.degenerate += static_cast<std::uint64_t>(all.end() - kept);
  all.erase(kept, all.end());
  double up = 0, down = 0;
  std::uint64_t facingUp = 0;
  for (const SceneryMesh::Triangle& t : all) {
    const auto [a, b, c] = t.vertex;
    // Along the ellipsoid's normal, not the line to its centre.
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
  mesh.facingDown = facingUp;
}

}  // namespace trimtab::terrain
