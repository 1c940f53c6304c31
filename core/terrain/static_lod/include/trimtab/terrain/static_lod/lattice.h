#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

/// A place in the terrain's local frame in steps of 1/256 m. They are whole numbers, so that the side of a
/// line on which a vertex lies is computed exactly.
struct Lattice {
  static constexpr double kStepM = 1.0 / 256;
  std::int32_t x = 0, y = 0, z = 0;

  friend bool operator==(const Lattice&, const Lattice&) = default;
  friend auto operator<=>(const Lattice&, const Lattice&) = default;
  Vec3 metres() const { return {x * kStepM, y * kStepM, z * kStepM}; }
};

/// Returns twice the area of the triangle seen from above, in square steps; positive if it is anticlockwise.
/// Exact within 4,000 km.
constexpr std::int64_t orientation(const Lattice& a, const Lattice& b, const Lattice& c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
         (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}
/// Returns rise over run of a triangle; kVerticalSlope if it stands upright or hangs over.
double slopeOf(const Lattice& a, const Lattice& b, const Lattice& c);
inline constexpr double kVerticalSlope = 1e6;

/// Gives all vertices of one place one number, in the order in which triangles first name them.
void weld(std::vector<Lattice>& vertices, std::vector<std::array<std::uint32_t, 3>>& triangles);

/// A tile's triangles on the lattice, every vertex once.
struct LatticeTile {
  std::string name;
  std::vector<Lattice> vertices;
  std::vector<std::uint8_t> shared;  ///< per vertex: another tile has it too
  std::vector<Vec3> normals;         ///< per vertex: sum over the triangles of all tiles, by area
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material;  ///< per triangle, of LatticeTiles::materials
  std::vector<TextureCorners> texture;  ///< per triangle; empty if the source has none
};

struct LatticeTiles {
  std::vector<LatticeTile> tiles;  ///< those that have triangles
  std::vector<std::string> materials;
  std::uint64_t joined = 0;      ///< vertices that another tile has too
  std::uint64_t degenerate = 0;  ///< triangles that repeat a vertex on the lattice
  std::uint64_t repeated = 0;    ///< triangles that another one of the tile repeats corner by corner
};

/// Converts all tiles. Vertices on open edges within kJoinM become one, of different tiles and of one tile.
///
/// Tiles hold their vertices as floats about their centre, 0.5 mm at 8 to 16 km: in the four sets of scenery
/// that the tests read, 29,000 border vertices lie within 1 mm of a neighbour's, and 60 from there to 3 cm.
/// Rounding to the lattice parts a pair by at most a step more in each direction, 7 mm in all.
Result<LatticeTiles> toLattice(std::span<const SceneryMesh> meshes, const LocalFrame& frame);
inline constexpr double kJoinM = 0.01;

}  // namespace trimtab::terrain
