#include "trimtab/terrain/scenery_lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

namespace trimtab::terrain {

namespace {

std::string lowerCase(std::string_view material) {
  std::string name;
  for (const char c : material) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

template <std::size_t N>
bool isAnyOf(const std::string& name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Higher lies on top.
int layerOf(const SceneryMesh& mesh, const std::string& material, LineFeature line) {
  if (mesh.airport) return material.starts_with("lf_") ? 3 : 2;
  return line == LineFeature::none ? 0 : 1;
}

}  // namespace

LineFeature lineFeatureOf(std::string_view material) {
  const std::string name = lowerCase(material);
  // Newer scenery has its roads in asphalt; that of airports is no line, and the caller knows airports.
  if (isAnyOf(name, std::array<std::string_view, 3>{"road", "freeway", "asphalt"})) return LineFeature::road;
  if (isAnyOf(name, std::array<std::string_view, 2>{"railroad", "railway"})) return LineFeature::railway;
  if (isAnyOf(name, std::array<std::string_view, 3>{"stream", "intermittentstream", "canal"}))
    return LineFeature::stream;
  return LineFeature::none;
}

bool isWater(std::string_view material) {
  return isAnyOf(lowerCase(material),
                 std::array<std::string_view, 8>{"ocean", "lake", "pond", "reservoir", "lagoon", "estuary",
                                                 "watercourse", "intermittentlake"});
}

std::vector<GroundTriangle> groundTriangles(std::span<const SceneryMesh> meshes, double nearLongitude) {
  std::array<std::vector<GroundTriangle>, 4> layers;
  for (const SceneryMesh& mesh : meshes) {
    std::vector<std::array<double, 2>> places;
    places.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) {
      const GeodeticPosition p = toGeodetic(v);
      places.push_back(
          {nearLongitude + std::remainder(p.longitude.value() - nearLongitude, 360.0), p.latitude.value()});
    }
    struct Look {
      GroundTriangle triangle;
      std::size_t layer;
    };
    std::vector<Look> looks;
    for (const std::string& material : mesh.materials) {
      Look look;
      look.triangle.colour = materialColour(material);
      look.triangle.line = mesh.airport ? LineFeature::none : lineFeatureOf(material);
      look.triangle.water = isWater(material);
      look.layer = static_cast<std::size_t>(layerOf(mesh, material, look.triangle.line));
      looks.push_back(look);
    }
    for (const SceneryMesh::Triangle& t : mesh.triangles) {
      const Look& look = looks[t.material];
      GroundTriangle triangle = look.triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.longitude[k] = places[t.vertex[k]][0];
        triangle.latitude[k] = places[t.vertex[k]][1];
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
