#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/normal_cone.h"
#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Axis-aligned box in the terrain's local frame, metres; rounded outwards so that it holds every vertex.
struct Box {
  float minX = 0, minY = 0, minZ = 0, maxX = 0, maxY = 0, maxZ = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

/// The levels of a terrain as flat arrays, one entry a node; meshes are not here. A quadtree of square tiles
/// of kTileCells x kTileCells cells: level 0 is the finest, node arrays are ordered by level, rows from
/// south, columns from west.
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

  // One entry a node.
  std::vector<Box> bounds;  ///< of everything this node or any descendant may draw
  /// Of every triangle that this node draws itself, at any mixture of its neighbours' levels; empty where
  /// they are not known.
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
