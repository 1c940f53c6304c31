#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"

/// Landscapes made for the tests of static levels of detail.
namespace trimtab::test {

inline LocalFrame testFrame() {
  return LocalFrame({Degrees{36}, Degrees{128}, Metres{0}});
}

/// Metres in the test frame.
using HeightAt = std::function<double(double x, double y)>;

inline double hills(double x, double y) {
  return 150 * std::sin(x / 310) * std::cos(y / 270) + 40 * std::sin(x / 83 + y / 61) + 6 * std::sin(x / 11) +
         20;
}

struct TinOptions {
  double x0 = 0, y0 = 0, cell = 30;
  std::uint32_t columns = 40, rows = 40, seed = 1;
  double jitter = 0.42;  ///< share of a cell; 0 at the edge of the tile
  std::function<bool(std::uint32_t, std::uint32_t)> hole = {};  ///< cells left out
  std::uint16_t materials = 3;
  double noiseM = 0;  ///< on every vertex, as floats of two tiles differ
};

/// A jittered grid whose cells are cut along either diagonal, in wavy bands of materials.
inline terrain::SceneryMesh tin(const std::string& name, const TinOptions& o,
                                const HeightAt& height = hills) {
  std::mt19937 random(o.seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  terrain::SceneryMesh mesh;
  mesh.name = name;
  for (std::uint16_t m = 0; m < o.materials; ++m) mesh.materials.push_back("Material" + std::to_string(m));
  const LocalFrame frame = testFrame();
  const auto inHole = [&](std::uint32_t c, std::uint32_t r) {
    return o.hole && c < o.columns && r < o.rows && o.hole(c, r);
  };
  std::vector<std::pair<double, double>> at;
  for (std::uint32_t r = 0; r <= o.rows; ++r)
    for (std::uint32_t c = 0; c <= o.columns; ++c) {
      bool edge = r == 0 || c == 0 || r == o.rows || c == o.columns;
      for (std::uint32_t dr = 0; dr < 2; ++dr)
        for (std::uint32_t dc = 0; dc < 2; ++dc)
          if (r >= dr && c >= dc && inHole(c - dc, r - dr)) edge = true;
      const double jx = unit(random) * o.jitter / 2, jy = unit(random) * o.jitter / 2;
      const double x = o.x0 + (c + (edge ? 0 : jx)) * o.cell, y = o.y0 + (r + (edge ? 0 : jy)) * o.cell;
      at.push_back({x, y});
      const Vec3 noise{unit(random) * o.noiseM, unit(random) * o.noiseM, unit(random) * o.noiseM};
      mesh.vertices.push_back(frame.toEcef(Vec3{x, y, height(x, y)} + noise));
    }
  for (std::uint32_t r = 0; r < o.rows; ++r)
    for (std::uint32_t c = 0; c < o.columns; ++c) {
      if (inHole(c, r)) continue;
      const std::uint32_t a = r * (o.columns + 1) + c, b = a + 1, d = a + o.columns + 1, e = d + 1;
      const double band = at[a].second / 230 + std::sin(at[a].first / 190);
      const std::uint16_t material =
          static_cast<std::uint16_t>(static_cast<int>(std::floor(band) + 1000) % o.materials);
      if (random() % 2) {
        mesh.triangles.push_back({{a, b, e}, material});
        mesh.triangles.push_back({{a, e, d}, material});
      } else {
        mesh.triangles.push_back({{a, b, d}, material});
        mesh.triangles.push_back({{b, e, d}, material});
      }
    }
  return mesh;
}

inline Result<std::shared_ptr<const terrain::StaticLodTerrain>> built(
    const std::vector<terrain::SceneryMesh>& tiles, std::uint32_t n) {
  return terrain::buildStaticLod(tiles, testFrame(), {n, {}, false});
}

}  // namespace trimtab::test
