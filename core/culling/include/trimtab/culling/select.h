#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"
#include "trimtab/frame/visible_set.h"

/// Selects the tiles that a frame draws and their levels, and records for every other tile why it is not
/// drawn. resources/docs/levels-of-detail.md explains the error measure.
namespace trimtab {

/// A LOD cut: the tiles that together cover the terrain once, each at its level, for one eye position. It
/// does not depend on the view direction or on culling, so culling cannot change what a drawn tile looks
/// like. Neighbouring tiles differ by at most one level.
struct LevelCut {
  std::vector<TileDraw> tiles;  ///< the order depends on the terrain only

  // What selectVisible reads beside the tiles; `gather` computes it.
  BoxArrays boxes;                                    ///< bounds of each tile
  BoxArrays blockBoxes;                               ///< bounds of each block of BoxArrays::kBlock tiles
  std::vector<std::uint32_t> triangles;               ///< drawn for each tile
  std::vector<std::uint64_t> blockTriangles;          ///< drawn for each block
  std::vector<NormalCone> cones;                      ///< of each tile; empty if the index has none
  std::vector<std::int16_t> blockSteepness;           ///< largest steepness (back_facing.h) in each block
  std::shared_ptr<std::vector<std::uint32_t>> nodes;  ///< shared with visible sets, so never changed

  // Working storage of selectLevels, kept so that a frame allocates nothing.
  std::vector<std::uint8_t> split;                     ///< one per node: 1 if its children are drawn instead
  std::vector<std::vector<std::uint32_t>> splitNodes;  ///< by level
  std::vector<std::uint32_t> stack;
};

/// Fills `cut` with tiles whose screen-space error at `eye` is at most maxErrorPx * lodScale where the data
/// allow it, restricted so that neighbours differ by one level at most. `pixelsPerRadian` is
/// pixelsPerRadian(view).
void selectLevels(const TerrainIndex& index, Vec3 eye, double maxErrorPx, double lodScale,
                  double pixelsPerRadian, LevelCut& cut);

/// Computes the rest of a cut from its tiles. selectLevels calls it.
void gather(const TerrainIndex& index, LevelCut& cut);

/// Fills `visible` with the tiles of the cut that are inside the view frustum (its far plane is infinite) and
/// not wholly beyond the sphere of radius `farM` around the eye. Never drops a tile that owns a pixel within
/// `farM`. Document D moves the far plane instead; with a sphere a turn of the head does not move the far
/// cut, and fog depends on the same distance. If `test` is false the whole cut is drawn (culling case
/// *none*). `hidden` is empty or has one flag per tile of the cut, not 0 if the tile is proven hidden.
/// `backFaces` also leaves out tiles all of whose triangles face away; back_facing.h says when that is
/// allowed.
void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible, double farM = std::numeric_limits<double>::infinity(),
                   std::span<const std::uint8_t> hidden = {}, bool backFaces = false);

/// Removes tiles from `visible.tiles` by one flag per tile, in order: 0 keeps it, 1 says it is proven hidden,
/// 2 that it is proven outside the view. The caller must update `visible.vertices`.
void removeOccluded(const LevelCut& cut, std::span<const std::uint8_t> flags, VisibleSet& visible);
/// Does the same for square tiles and updates `visible.vertices`.
void removeOccluded(const TerrainIndex& index, std::span<const std::uint8_t> flags, VisibleSet& visible);

}  // namespace trimtab
