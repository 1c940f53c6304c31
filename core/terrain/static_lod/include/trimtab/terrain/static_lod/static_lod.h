#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/scenery/scenery.h"

/// Static levels of detail for scenery (document E): a BSP whose leaves hold n/2 to n source triangles,
/// merged and simplified upward to n +/- 1 a node.
namespace trimtab::terrain {

struct StaticLodOptions {
  std::uint32_t trianglesPerNode = 2000;  ///< 1 to kMostTrianglesPerNode
  /// Reports progress; returning false cancels. It is called after each node; `fraction` counts whole tiles.
  std::function<bool(double fraction, const std::string& what)> progress;
  /// Keeps roads, railways, streams and shorelines in a node while they are at least a pixel wide at the
  /// distance where the node may first be drawn (RMS error of one pixel). Document E, as published, loses
  /// them at the first step. Nodes may then hold more than n triangles, and state at least that pixel's width
  /// as their error.
  bool keepLines = false;
};

/// Builds the trees of all tiles in `frame`, several tiles at a time. It first joins vertices that
/// neighbouring tiles share, so that borders stay closed between tiles too. The same input gives the same
/// bytes on any number of cores. It refuses numbers that are not finite, places more than 1000 km from the
/// frame's origin, tiles wider than 120 km and indices past their arrays. It leaves out tiles without
/// triangles, with a warning.
Result<std::shared_ptr<const StaticLodTerrain>> buildStaticLod(std::span<const SceneryMesh> tiles,
                                                               const LocalFrame& frame,
                                                               const StaticLodOptions& options);

/// What n may say about leaves. Document E states n = 2000 for its example, but not which of the two it is.
enum class LeafReading {
  atMost,   ///< leaves hold n/2 to n triangles, as the builder splits
  atLeast,  ///< leaves hold n to 2n triangles
};

/// What document E's rule allows a tile: leaves as the reading says, and n - 1 to n + 1 triangles in every
/// node above. One collapse removes two triangles, so the builder stops at n or n + 1.
struct StaticLodLimits {
  std::uint32_t levels = 0;                     ///< the fewest
  std::uint64_t leastFaces = 0, mostFaces = 0;  ///< sums over all nodes
};
/// Returns the limits of a tile of so many source triangles. Nodes that are locked minima, and nodes that
/// keep lines, may exceed them.
StaticLodLimits staticLodLimits(std::uint64_t triangles, std::uint32_t trianglesPerNode,
                                LeafReading reading = LeafReading::atMost);

/// What the builder's splits at the median give under a reading: every split halves, so that the tree is
/// complete.
struct HalvedTree {
  std::uint64_t leaves = 1, largestLeaf = 0;
  std::uint32_t levels = 1;  ///< roots and leaves included, as document E counts
  std::uint64_t faces = 0;   ///< of all nodes, if every node above the leaves holds n
};
HalvedTree halvedTree(std::uint64_t triangles, std::uint32_t trianglesPerNode, LeafReading reading);

/// Describes one tile in document E's terms, beside what its rule allows.
struct StaticLodReport {
  std::string tile;
  std::uint64_t triangles = 0, faces = 0;
  std::uint64_t distinctFaces = 0;  ///< as `faces`, but a face that several nodes have counts once
  std::uint32_t trianglesPerNode = 0, levels = 0, lockedMinima = 0;
  std::vector<std::uint64_t> facesOfLevel;   ///< as StaticLodCounts
  std::vector<double> rmsErrorM, maxErrorM;  ///< largest of the nodes of a level
  StaticLodLimits limits;
};
StaticLodReport reportStaticLod(const StaticLodTerrain& terrain, std::size_t tile);
/// Returns the tile whose number of source triangles is nearest; the terrain must have at least one tile.
std::size_t tileNearest(const StaticLodTerrain& terrain, std::uint64_t triangles);

}  // namespace trimtab::terrain
