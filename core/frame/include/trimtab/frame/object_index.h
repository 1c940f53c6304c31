#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// One thing that stands on the ground: a model, where, how it is turned and how large.
struct ObjectInstance {
  float x = 0, y = 0, z = 0;  ///< the model's origin, metres from its cell's origin, along the local frame
  /// Unit quaternion x, y, z, w times 32767, from the model's axes (x east, y north, z up, before its
  /// heading) to the local frame's.
  std::array<std::int16_t, 4> turn{0, 0, 0, 32767};
  float scale = 1;          ///< greater than 0
  std::uint32_t model = 0;  ///< its number in ObjectIndex::models
};
static_assert(sizeof(ObjectInstance) == 28);

/// What stands on the ground of a terrain, as flat arrays without meshes: models with levels of known error,
/// and their instances in a tree of cells.
///
/// Cells are in depth-first order, so a cell's subtree is the run of cells from it to `end`, and the
/// instances of a subtree follow each other. Instances stand in cells without children only. Whoever selects
/// walks the cells once and jumps to `end` where nothing of a subtree is drawn.
struct ObjectIndex {
  /// One mesh of a model.
  struct Level {
    /// The worst distance, metres at scale 1, between this mesh and the model's first level, measured both
    /// ways. 0 for the first level.
    float errorM = 0;
    std::uint32_t triangles = 0, vertices = 0;
  };
  struct Model {
    std::uint32_t firstLevel = 0, levels = 0;  ///< from the finest; errors rise strictly
    float radiusM = 0;  ///< the farthest vertex of any level from the model's origin, metres at scale 1
  };
  struct Cell {
    Box bounds;                                      ///< of everything that its instances may draw
    std::array<std::int32_t, 3> origin{};            ///< multiples of 16 m in the local frame
    std::uint32_t firstInstance = 0, instances = 0;  ///< of the whole subtree
    std::uint32_t end = 0;                           ///< the first cell that is not of this subtree
    float largestRadiusM = 0;                        ///< the greatest radius times scale of an instance
    /// The greatest error times scale, metres, of the coarsest level of an instance. Where a rule accepts as
    /// much, every instance is drawn by its coarsest level.
    float coarsestFromM = 0;

    bool isLeaf(std::uint32_t number) const { return end == number + 1; }
  };

  LocalFrame frame;
  std::vector<Level> levels;
  std::vector<Model> models;
  std::vector<Cell> cells;  ///< the first is the root; empty if nothing stands on the ground
  std::vector<ObjectInstance> instances;
};

}  // namespace trimtab
