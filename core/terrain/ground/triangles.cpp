#include "trimtab/terrain/ground/triangles.h"

#include <algorithm>
#include <string>

namespace trimtab::terrain {

namespace {

/// Higher lies on top.
std::size_t layerOf(const SceneryMesh& mesh, const std::string& material, LineFeature line) {
  if (mesh.airport) return material.starts_with("lf_") ? 3 : 2;
  return line == LineFeature::none ? 0 : 1;
}

}  // namespace

Result<std::vector<GroundTriangle>> SceneryGround::over(const Rectangle& degrees) const {
  std::array<std::vector<GroundTriangle>, 4> layers;
  const auto& tiles = scenery_.tiles();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!tiles[i].extent.turned(turn_).meets(degrees)) continue;
    const auto placed = scenery_.mesh(i);
    if (!placed) return placed.findings();
    const SceneryMesh& mesh = (*placed)->mesh;
    struct Look {
      GroundTriangle triangle;
      std::size_t layer;
    };
    std::vector<Look> looks;
    for (const std::string& material : mesh.materials) {
      Look look;
      look.triangle.colour = materialColour(material);
      look.triangle.line = mesh.airport ? LineFeature::none : lineFeatureOf(material);
      look.layer = layerOf(mesh, material, look.triangle.line);
      looks.push_back(look);
    }
    for (const SceneryMesh::Triangle& t : mesh.triangles) {
      Rectangle extent = Rectangle::none();
      for (const std::uint32_t v : t.vertex) {
        const Vec3& p = (*placed)->places[v];
        extent.add(p.x + turn_, p.y);
      }
      if (!extent.meets(degrees)) continue;
      const Look& look = looks[t.material];
      GroundTriangle triangle = look.triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = (*placed)->places[t.vertex[k]];
        triangle.longitude[k] = p.x + turn_;
        triangle.latitude[k] = p.y;
      }
      layers[look.layer].push_back(triangle);
    }
  }
  std::vector<GroundTriangle> all;
  all.reserve(layers[0].size() + layers[1].size() + layers[2].size() + layers[3].size());
  for (const auto& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
  return all;
}

}  // namespace trimtab::terrain
