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
  std::vector<std::uint16_t> material;  ///< per triangle
};
/// Returns the nodes that a tile draws at a level; 0 is the root. It includes the leaves above that level.
std::vector<std::uint32_t> nodesOfLevel(const StaticLodTerrain& terrain, std::size_t tile,
                                        std::uint32_t level);
/// Returns what is drawn of a tile at a level; 0 is the root. It includes the leaves above that level, so
/// that the deepest level is the source.
LatticeSurface surfaceOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);
/// Returns the number of levels of one tile.
std::uint32_t levelsOf(const StaticLodTerrain& terrain, std::size_t tile);
/// Returns the bytes of a level's nodes: vertices and indices as they are uploaded.
std::uint64_t bytesOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);

/// Returns a tile's source mesh, so that trees can be built from it with other options. Its vertices lie on
/// the lattice already, so the same options give the same trees.
SceneryMesh sourceOf(const StaticLodTerrain& terrain, std::size_t tile);

/// States how much of a tile's lines a level still shows, by length in metres. A border edge of a road,
/// railway or stream counts if such a triangle is drawn at the middle of the source's triangle; an edge of a
/// shoreline counts if water is drawn at the middle of its water triangle and land at that of its land
/// triangle.
struct LineShare {
  double lineM = 0, lineLeftM = 0;
  double shoreM = 0, shoreLeftM = 0;
  double ofLines() const { return lineM > 0 ? lineLeftM / lineM : 1; }
  double ofShores() const { return shoreM > 0 ? shoreLeftM / shoreM : 1; }
};
/// Returns them level by level.
std::vector<LineShare> lineShares(const StaticLodTerrain& terrain, std::size_t tile);

}  // namespace trimtab::terrain
