#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/scenery/scenery.h"

/// Static levels of detail for scenery, as document E describes them ("Static Level-of-Detail for
/// FlightGear", World Custom Scenery Project). Each tile becomes a binary space partition (BSP): its leaves
/// hold n/2 to n source triangles, and each node above holds the triangles of its two children, simplified to
/// n - 1 to n + 1.
namespace trimtab::terrain {

struct StaticLodOptions {
  std::uint32_t trianglesPerNode = 2000;  ///< n; 1 to kMostTrianglesPerNode, else nothing is built
  /// Reports progress now and then on the calling thread. `fraction` is the share of the source triangles
  /// whose tiles are finished; `what` names the work. Returning false cancels: the result is then a finding
  /// that says so.
  std::function<bool(double fraction, const std::string& what)> progress;
  /// Keeps roads, railways, streams and shorelines in a node as long as they are at least one pixel wide at
  /// the distance from which on the node may be drawn: where its RMS error covers one pixel. Document E's
  /// method loses them when it first simplifies. With this option nodes may hold more than n triangles, and
  /// the width of a line that a node loses is part of the node's error.
  bool keepLines = false;
};

/// Builds one tree for each tile, with positions in metres in `frame`, several tiles at a time. It first
/// joins vertices at which neighbouring tiles meet, so that borders stay closed between tiles too. The same
/// input gives the same bytes on any number of cores. Nothing is built, and a finding says why, if a
/// coordinate is not finite or lies more than 1000 km from the frame's origin, if a tile is wider than 120
/// km, or if an index is beyond the end of its array. Tiles without triangles are left out with a warning;
/// later tiles move up.
Result<std::shared_ptr<const StaticLodTerrain>> buildStaticLod(std::span<const SceneryMesh> tiles,
                                                               const LocalFrame& frame,
                                                               const StaticLodOptions& options);

/// Says what n means for leaves. Document E's rule is the first, but the 4 levels of its example, n = 2000,
/// follow from the second.
enum class LeafReading {
  atMost,   ///< leaves hold n/2 to n triangles, as the builder splits
  atLeast,  ///< leaves hold n to 2n triangles
};

/// The numbers that document E's rule allows a tile: leaves as the reading says, and n - 1 to n + 1 triangles
/// in every node above. One collapse removes two triangles, so the builder stops at n or n + 1.
struct StaticLodLimits {
  std::uint32_t levels = 0;                     ///< the fewest levels, root and leaves included
  std::uint64_t leastFaces = 0, mostFaces = 0;  ///< sums of the triangles of all nodes, leaves included
};
/// Returns the limits of a tile of `triangles` source triangles. A tile may exceed them if it has nodes that
/// cannot be simplified to n because all their vertices are locked (lockedMinima), or nodes that keep lines.
StaticLodLimits staticLodLimits(std::uint64_t triangles, std::uint32_t trianglesPerNode,
                                LeafReading reading = LeafReading::atMost);

/// Holds what the builder's splits at the median give under a reading: every split halves, so that the tree
/// is complete.
struct HalvedTree {
  std::uint64_t leaves = 1, largestLeaf = 0;
  std::uint32_t levels = 1;  ///< roots and leaves included, as document E counts
  std::uint64_t faces = 0;   ///< of all nodes, if every node above the leaves holds n
};
HalvedTree halvedTree(std::uint64_t triangles, std::uint32_t trianglesPerNode, LeafReading reading);

/// One tile in the terms of document E's table, and what the document's rule allows the tile.
struct StaticLodReport {
  std::string tile;  ///< its name
  std::uint64_t triangles = 0, faces = 0;
  std::uint64_t distinctFaces = 0;  ///< as `faces`, but a face that several nodes have counts once
  std::uint32_t trianglesPerNode = 0, levels = 0, lockedMinima = 0;
  std::vector<std::uint64_t> facesOfLevel;   ///< by level, the root's first
  std::vector<double> rmsErrorM, maxErrorM;  ///< by level: the largest that a node states, metres
  StaticLodLimits limits;
};
/// Describes the tile of that index, which must exist.
StaticLodReport reportStaticLod(const StaticLodTerrain& terrain, std::size_t tile);
/// Returns the index of the tile whose number of source triangles is nearest to `triangles`, the first of
/// several. The terrain must have at least one tile.
std::size_t tileNearest(const StaticLodTerrain& terrain, std::uint64_t triangles);

}  // namespace trimtab::terrain
