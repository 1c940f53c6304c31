#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/frame/static_lod_index.h"
#include "trimtab/units/result.h"

/// The static LOD trees of document E as a renderer reads them.
namespace trimtab::terrain {

/// A vertex as the renderer uploads it. Its position is relative to the tile's origin, in multiples of 1/256
/// m; a vertex that nodes or tiles share is the same to the bit in all of them.
struct StaticLodVertex {
  float x, y, z;
  std::int8_t normal[3];  ///< 127 times the normal, local frame
  std::uint8_t unused = 0;
  std::uint8_t colour[4];  ///< sRGB of the material
};
static_assert(sizeof(StaticLodVertex) == 20);

/// The triangles of all nodes of one tile, node by node; nodes share vertices.
struct StaticLodTile {
  std::string name;
  std::int32_t origin[3] = {};  ///< multiples of 16 m in the local frame: metres = origin * 16
  std::vector<StaticLodVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle
  std::vector<std::uint8_t>
      locked;  ///< per triangle: bit i says that the edge from corner i to i+1 may not change
  std::vector<std::uint16_t> material;  ///< per triangle
  /// Texture coordinates as FlightGear's, per vertex; empty unless they were kept.
  std::vector<std::array<float, 2>> texture;
};

/// The triangles of a node, in its tile.
struct StaticLodRange {
  std::uint32_t firstTriangle = 0, triangles = 0;
};

struct StaticLodCounts {
  std::uint32_t levels = 0;  ///< of the deepest tile
  std::uint64_t sourceTriangles = 0, faces = 0,
                distinctFaces = 0;  ///< the last counts faces that nodes share once
  std::vector<std::uint64_t>
      facesOfLevel;  ///< by depth from the root; a leaf above the deepest level counts in all below it
  std::uint64_t lockedMinima = 0;    ///< nodes that could not reach n
  std::uint64_t joinedVertices = 0;  ///< vertices on borders of tiles that a neighbour has too
  std::uint64_t degenerate = 0;      ///< source triangles dropped because they repeat a vertex on the lattice
  std::uint64_t repeated = 0;        ///< source triangles dropped because another one has the same corners
  std::uint64_t folded = 0;          ///< source triangles kept that stand upright or face down
  std::uint64_t bytes = 0;           ///< of all arrays
};

inline constexpr std::uint32_t kMostTrianglesPerNode = 1000000;

struct StaticLodTerrain {
  std::uint32_t trianglesPerNode = 2000;  ///< n
  StaticLodIndex index;
  std::vector<StaticLodTile> tiles;
  std::vector<StaticLodRange> ranges;  ///< one per node of the index
  std::vector<std::string> materials;
  StaticLodCounts counts;
};

/// Reports whether any tile kept its texture coordinates.
bool hasTexture(const StaticLodTerrain& terrain);

/// Computes the counts that follow from the index and the arrays.
void countStaticLod(StaticLodTerrain& terrain);

/// Write and read one little-endian file with a checksum. Writing is atomic; reading checks sizes before it
/// allocates.
Result<Done> writeStaticLod(const std::filesystem::path& file, const StaticLodTerrain& terrain);
Result<std::shared_ptr<const StaticLodTerrain>> readStaticLod(const std::filesystem::path& file);

}  // namespace trimtab::terrain
