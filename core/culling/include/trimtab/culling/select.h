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

/// Which tiles a frame draws, at which level, and for every tile that is not drawn, why.
namespace trimtab {

/// The cut through the levels for an eye's position: independent of view direction and of culling, so that
/// culling cannot change what a drawn tile looks like. Neighbouring tiles differ by at most one level.
struct LevelCut {
  std::vector<TileDraw> tiles;  ///< order is a function of the terrain only, near ones mostly together

  // What selectVisible reads beside them, which `gather` makes.
  BoxArrays boxes;                            ///< the tiles' bounds, in order
  BoxArrays blockBoxes;                       ///< of each BoxArrays::kBlock tiles in turn
  std::vector<std::uint32_t> triangles;       ///< that each tile draws
  std::vector<std::uint64_t> blockTriangles;  ///< that the tiles of each block draw
  std::vector<NormalCone> cones;              ///< in order; empty where the index has none
  std::vector<std::int16_t> blockSteepness;   ///< the largest of steepness (back_facing.h) in each block
  std::shared_ptr<std::vector<std::uint32_t>> nodes;  ///< the tiles', shared with visible sets: never changed

  // What selectLevels works with, kept so that a frame allocates nothing.
  std::vector<std::uint8_t> split;                     ///< one a node: its children stand for it
  std::vector<std::vector<std::uint32_t>> splitNodes;  ///< by level
  std::vector<std::uint32_t> stack;
};

/// Tiles whose screen-space error at `eye` is at most `maxErrorPx` x `lodScale` where the data allow,
/// restricted to one level's difference between neighbours. `pixelsPerRadian` is of the view's finer axis.
void selectLevels(const TerrainIndex& index, Vec3 eye, double maxErrorPx, double lodScale,
                  double pixelsPerRadian, LevelCut& cut);

/// Makes the rest of a cut from its tiles; selectLevels does it.
void gather(const TerrainIndex& index, LevelCut& cut);

/// Tests every tile of the cut against the view frustum (near, left, right, bottom, top; the far plane is
/// infinite), and what is in it against the sphere of radius `farM` around the eye. A sphere, where document
/// D moves the far plane: so a head that turns does not move the cut, and fog is by the same distance. Never
/// drops a tile that owns a pixel within `farM`. `test` false draws the whole cut (culling case *none*).
/// `hidden`: one a tile of the cut, not 0 where it is proven hidden from the eye's place; or empty.
/// `backFaces`: tiles all of whose triangles face away are left out too, which back_facing.h says when one
/// may ask for.
void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible, double farM = std::numeric_limits<double>::infinity(),
                   std::span<const std::uint8_t> hidden = {}, bool backFaces = false);

/// Removes tiles by one flag a tile of `visible.tiles`, in order: 0 stays, 1 is proven hidden, 2 is proven
/// outside the view (by finer boxes than the index has).
/// `vertices` is the caller's.
void removeOccluded(const LevelCut& cut, std::span<const std::uint8_t> flags, VisibleSet& visible);
/// The same for tiles, which know their vertices.
void removeOccluded(const TerrainIndex& index, std::span<const std::uint8_t> flags, VisibleSet& visible);

}  // namespace trimtab
