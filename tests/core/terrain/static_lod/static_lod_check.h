#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"

/// What must hold for any trees, found from their arrays alone.
namespace trimtab::test {

/// A directed edge between two places with how often it is used that way more than the other way.
struct BorderEdge {
  std::uint32_t low, high;
  std::int32_t count;
  friend bool operator==(const BorderEdge&, const BorderEdge&) = default;
};
using Border = std::vector<BorderEdge>;  ///< sorted; none with count 0

/// Trees with places by number: equal numbers are equal to the bit, in all tiles.
class PlacedTrees {
 public:
  using Place = std::array<std::int64_t, 3>;  ///< steps of 1/256 m in the terrain's frame
  using Corners = std::array<std::uint32_t, 3>;

  explicit PlacedTrees(const terrain::StaticLodTerrain& terrain);
  const terrain::StaticLodTerrain& terrain() const { return terrain_; }
  bool onLattice() const { return onLattice_; }
  std::uint32_t places() const { return static_cast<std::uint32_t>(places_.size()); }
  const Place& place(std::uint32_t number) const { return places_[number]; }
  std::vector<Corners> triangles(std::uint32_t node) const;
  /// What remains of a node's edges when those that two triangles use both ways are taken off.
  Border border(std::uint32_t node) const;
  Border border(const std::vector<std::uint32_t>& nodes) const;
  /// Twice the area from above.
  std::int64_t area(const Corners& t) const;
  /// Children before their parents' siblings: every leaf below a node.
  std::vector<std::uint32_t> leavesOf(std::uint32_t node) const;

 private:
  const terrain::StaticLodTerrain& terrain_;
  std::vector<Place> places_;
  std::vector<std::vector<std::uint32_t>> placeOf_;  ///< one a tile and vertex
  bool onLattice_ = true;
};

struct TreeFaults {
  std::uint64_t cracks = 0;       ///< nodes whose border differs from their children's
  std::uint64_t newFolds = 0;     ///< triangles facing down or upright that the node's children have not
  std::uint64_t lostArea = 0;     ///< nodes whose area from above differs from their children's, in any digit
  std::uint64_t wrongLeaves = 0;  ///< not n/2 to n, but for a tile that is one leaf
  std::uint64_t wrongNodes = 0;   ///< not n +/- 1 and no locked minimum, or called one and within n + 1
  std::uint64_t wrongErrors = 0;  ///< falling towards the root, negative, or not finite
  std::uint64_t wrongBounds = 0;  ///< a vertex outside
  std::uint64_t wrongLocks = 0;   ///< a border edge that may change, or a locked edge of the source gone
  std::uint64_t unequalNormals = 0;  ///< of border places between tiles
  std::uint64_t distinctFaces = 0;
  std::uint64_t lockedMinima = 0;
};
TreeFaults faultsOf(const PlacedTrees& trees);

/// Random cuts through all trees; the number of those whose border is not the source's.
int openCuts(const PlacedTrees& trees, int cuts, std::uint32_t seed);

}  // namespace trimtab::test
