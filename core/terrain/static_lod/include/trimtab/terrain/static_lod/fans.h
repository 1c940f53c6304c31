#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"

/// Measures how well the triangles of a level can be put into strips and fans ("fanification"), and how often
/// a cache of transformed vertices misses: statistics that document E asks for.
namespace trimtab::terrain {

/// A strip or a fan: its vertices, two more than its triangles.
using VertexRun = std::vector<std::uint32_t>;

/// Puts triangles (three indices each) into strips. Each strip starts at the first triangle that is left,
/// with that of its three corners that gives the longest strip, and goes forwards only. Every triangle is in
/// one strip and keeps its winding.
std::vector<VertexRun> greedyStrips(std::span<const std::uint32_t> indices);
/// Puts triangles into fans in the same way: around that corner of the first triangle left that gives the
/// longest fan, in both directions. The hub comes first.
std::vector<VertexRun> greedyFans(std::span<const std::uint32_t> indices);
/// Counts the indices that are not among the last `cache` vertices that missed (first in, first out).
std::uint64_t cacheMisses(std::span<const std::uint32_t> indices, std::size_t cache);

/// Sums over the nodes that a tile draws at a level. Strips and fans end with their node and its materials,
/// and each node starts with an empty cache, because a node is drawn by itself. Misses are those of the order
/// that is stored and drawn.
struct FanStatistics {
  std::uint64_t triangles = 0, strips = 0, fans = 0, misses16 = 0, misses32 = 0;
  double trianglesPerStrip() const { return each(triangles, strips); }
  double trianglesPerFan() const { return each(triangles, fans); }
  /// Average cache miss ratio: vertices transformed per triangle, by a FIFO of 16 or 32 vertices.
  double acmr16() const { return each(misses16, triangles); }
  double acmr32() const { return each(misses32, triangles); }

 private:
  static double each(std::uint64_t a, std::uint64_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0;
  }
};
FanStatistics fanStatistics(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);

}  // namespace trimtab::terrain
