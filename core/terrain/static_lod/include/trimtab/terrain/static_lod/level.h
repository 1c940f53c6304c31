#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/lattice.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

/// A surface on the lattice of the trees' frame.
struct LatticeSurface {
  std::vector<Lattice> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material;  ///< one a triangle
};
/// What is drawn of a tile at a level, the root's being 0; leaves above it with it, so that the deepest is
/// the source.
LatticeSurface surfaceOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);
/// Levels of one tile.
std::uint32_t levelsOf(const StaticLodTerrain& terrain, std::size_t tile);
/// Memory of a level's nodes: vertices and indices as they are uploaded.
std::uint64_t bytesOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);

/// A tile's source again, so that trees can be built from it in another way: on the lattice already, so the
/// same trees come out.
SceneryMesh sourceOf(const StaticLodTerrain& terrain, std::size_t tile);

/// How much of a tile's lines a level still shows, by length, metres: roads, railways and streams by the
/// border of their triangles, where such a triangle covers the middle of the source's; shorelines where there
/// is water on the one side and land on the other, at the middles of the source's triangles.
struct LineShare {
  double lineM = 0, lineLeftM = 0;
  double shoreM = 0, shoreLeftM = 0;
  double ofLines() const { return lineM > 0 ? lineLeftM / lineM : 1; }
  double ofShores() const { return shoreM > 0 ? shoreLeftM / shoreM : 1; }
};
std::vector<LineShare> lineShares(const StaticLodTerrain& terrain, std::size_t tile);  ///< one a level

}  // namespace trimtab::terrain
