#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/static_lod/error.h"
#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// The tree of one tile with its meshes, while it is built. Parents come before their children.
struct LodTree {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// The `freeFrom` of a vertex that no node of the tile may move.
  static constexpr std::int8_t kFixed = -1;

  struct Node {
    std::array<std::uint32_t, 2> children{kNone, kNone};
    std::uint32_t first = 0, last = 0;  ///< of the source triangles in `order`
    std::uint8_t depth = 0;
    bool lockedMinimum = false;
    double rmsErrorM = 0, maxErrorM = 0;  ///< vertical
    double borderErrorM = 0;              ///< horizontal, of the borders between materials
    double slopeMax = 0;
    double lineWidthM = 0;  ///< lines as wide as this or wider were kept; it states no lesser error
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint16_t> material;
    std::vector<TextureCorners> texture;  ///< per triangle; empty if the tile has none
  };

  Lattice origin;  ///< whole multiples of 16 m
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;  ///< source triangles, leaf by leaf
  std::vector<Lattice> vertices;     ///< the source's, then those that collapses made
  std::vector<Vec3> normals;         ///< per vertex, of any length
  /// Per vertex: one more than the depth of the shallowest node whose border it is on, because deeper nodes
  /// may not move it; or kFixed.
  std::vector<std::int8_t> freeFrom;
  std::vector<float> lineWidthM;  ///< per vertex, as lineWidths(); empty if lines are not kept
  std::uint64_t distinctFaces = 0, folded = 0;

  /// Reports whether a node of that depth must leave the vertex where it is.
  bool locked(std::uint32_t vertex, std::uint8_t depth) const {
    return freeFrom[vertex] == kFixed || freeFrom[vertex] < static_cast<int>(depth);
  }
  /// Reports whether the vertex is on a line that a pixel of this width shows.
  bool onLine(std::uint32_t vertex, double pixelM) const {
    return vertex < lineWidthM.size() && lineWidthM[vertex] > 0 && lineWidthM[vertex] >= pixelM;
  }
};

/// Builds and measures a tile's tree. Splits by upright planes across the longer side, at the median of the
/// triangles' middles, down to leaves of n/2 to n triangles; then merges and simplifies upwards.
/// `lineWidthM` has one width per vertex of the tile, to keep lines, or is empty. Calls `goesOn` once or
/// twice per node; if that returns false, the result is a tree without nodes.
LodTree buildTree(const LatticeTile& tile, std::uint32_t trianglesPerNode, std::vector<float> lineWidthM,
                  std::span<const std::string> materials, const std::function<bool()>& goesOn = {});

/// Measures the errors of every node, children first. Vertical errors compare the vertices of the source
/// triangles below the node with the node's surface, and the node's vertices with those triangles; each place
/// counts once and with the same weight. If the source covers ground twice, the nearest sheet counts.
/// Border errors are BorderMeasure's. No error is less than a child's. Calls `goesOn` once per node and
/// returns false if it does.
bool measureTree(const LatticeTile& tile, LodTree& tree, std::span<const std::string> materials,
                 const std::function<bool()>& goesOn = {});

/// Measures the vertical errors of single nodes that are no leaves, without their children's share.
class NodeMeasure {
 public:
  /// Both must outlive it. The tree must have its `order`, and may grow.
  NodeMeasure(const LatticeTile& tile, const LodTree& tree);
  struct Error {
    double rmsM = 0, maxM = 0;
  };
  Error of(const LodTree::Node& node);

 private:
  const LatticeTile& tile_;
  const LodTree& tree_;
  std::vector<std::array<std::uint32_t, 3>> source_;  ///< leaf by leaf, so that a node's are one stretch
  VerticalDistance toSource_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
};

}  // namespace trimtab::terrain
