#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/normal_cone.h"
#include "trimtab/units/geodesy.h"

namespace trimtab {

/// An axis-aligned box in the terrain's local frame, metres, rounded outwards so that it holds every vertex.
struct Box {
  float minX = 0, minY = 0, minZ = 0, maxX = 0, maxY = 0, maxZ = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

/// The tiles of a terrain as flat arrays with one entry per node, without their meshes: a quadtree of tiles
/// of kTileCells x kTileCells cells. Level 0 is the finest. Nodes are ordered by level, then by row from the
/// south, then by column from the west.
struct TerrainIndex {
  static constexpr int kTileCells = 32;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  struct Level {
    std::uint32_t firstNode = 0;
    std::uint32_t columns = 0,
                  rows = 0;  ///< tiles; the eastmost and northmost may reach past the data: posts clamp
  };

  LocalFrame frame;
  std::vector<Level> levels;  ///< from finest to the single root (or a few roots)

  // One entry per node.
  std::vector<Box> bounds;  ///< of everything this node or any descendant may draw
  /// Cones of the normals of all triangles that a node itself draws, whatever its neighbours' levels; empty
  /// if they are unknown.
  std::vector<NormalCone> cones;
  std::vector<float>
      errorM;  ///< largest vertical distance to the source posts below it; monotone up the tree
  std::vector<float> slopeMax;  ///< largest slope (rise over run) of a triangle of this node or a descendant,
                                ///< and of the neighbours
  std::vector<std::uint8_t> level;
  std::vector<std::uint32_t> parent;                   ///< kNone at the roots
  std::vector<std::array<std::uint32_t, 4>> children;  ///< SW, SE, NW, NE; kNone where outside or at level 0
  std::vector<std::array<std::uint32_t, 4>>
      neighbours;  ///< W, E, S, N of the same level; kNone at the border

  std::size_t size() const { return bounds.size(); }
};

}  // namespace trimtab
