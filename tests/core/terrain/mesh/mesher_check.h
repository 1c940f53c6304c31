#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trimtab/terrain/mesh/mesher.h"

/// Meshes of height fields held against their promises by brute force, with nothing of the mesher's own.
namespace trimtab::test {

using Point = terrain::PolygonMesher::Point;

/// Posts that own their heights.
struct Field {
  std::uint32_t columns, rows;
  std::vector<float> z;
  Field(std::uint32_t columns, std::uint32_t rows, const std::function<double(int, int)>& height);
  terrain::HeightField view() const { return {z.data(), columns, rows, columns}; }
};

/// Rough ground with roughness at every scale, made of lattice noise: `gain` from a scale to its half.
Field fractal(std::uint32_t columns, std::uint32_t rows, std::uint32_t seed, double relief = 1000,
              double gain = 0.6);

struct MeshFacts {
  std::string wrong;  ///< the first promise that is broken
  double maxM = 0, rmsM = 0;
  std::uint64_t posts = 0;
};
/// Errors are those at every `step`-th post. `border` has every vertex of the polygon, anticlockwise.
MeshFacts checkMesh(const terrain::HeightField& field, const std::vector<Point>& border,
                    const std::vector<Point>& vertices, const std::vector<float>& z,
                    const std::vector<std::uint32_t>& indices, std::uint32_t step = 1);
MeshFacts checkMesh(const terrain::HeightField& field, const std::vector<Point>& border,
                    const terrain::PolygonMesher& mesher);

}  // namespace trimtab::test
