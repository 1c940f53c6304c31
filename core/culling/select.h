#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"

/// Which tiles a frame draws, at which level, and for every tile that is not drawn, why.
namespace trimtab {

enum class CullReason : std::uint8_t {
  drawn,
  outside_frustum,
  occluded,           ///< proven hidden by the horizon or the depth map
  beyond_visibility,  ///< in the frustum, but wholly beyond the weather's far distance
  other_level         ///< its ancestor or descendants stand for it
};

/// One tile of the cut. `coarser` has bits W=1, E=2, S=4, N=8 where the neighbour is one level coarser and
/// the border uses the coarser posts.
struct TileDraw {
  std::uint32_t node = 0;
  std::uint8_t coarser = 0;
};

/// The cut through the levels for an eye's position: independent of view direction and of culling, so that
/// culling cannot change what a drawn tile looks like. Neighbouring tiles differ by at most one level.
struct LevelCut {
  std::vector<TileDraw> tiles;  ///< order is a function of the terrain only
  BoxArrays boxes;              ///< the tiles' bounds, in order

  // What selectLevels works with, kept so that a frame allocates nothing.
  std::vector<std::uint8_t> split;                     ///< one a node: its children stand for it
  std::vector<std::vector<std::uint32_t>> splitNodes;  ///< by level
  std::vector<std::uint32_t> stack;
};

/// Tiles whose screen-space error at `eye` is at most `maxErrorPx` x `lodScale` where the data allow,
/// restricted to one level's difference between neighbours. `pixelsPerRadian` is of the view's finer axis.
void selectLevels(const TerrainIndex& index, Vec3 eye, double maxErrorPx, double lodScale,
                  double pixelsPerRadian, LevelCut& cut);

/// Fills `cut.boxes`, which selectVisible reads; selectLevels does it. `bounds`: the index's.
void gatherBoxes(std::span<const Box> bounds, LevelCut& cut);

struct VisibleSet {
  std::vector<TileDraw> tiles;                                         ///< to draw
  std::vector<CullReason> reason;                                      ///< one a node of the index
  std::size_t outsideFrustum = 0, occluded = 0, beyondVisibility = 0;  ///< tiles of the cut, by reason
  std::uint64_t triangles = 0, vertices = 0;  ///< of the tiles drawn; degenerate triangles not counted
};

/// Tests every tile of the cut against the view frustum (near, left, right, bottom, top; the far plane is
/// infinite), and what is in it against the sphere of radius `farM` around the eye. A sphere, where document
/// D moves the far plane: so a head that turns does not move the cut, and fog is by the same distance. Never
/// drops a tile that owns a pixel within `farM`. `test` false draws the whole cut (culling case *none*).
/// `hidden`: one a tile of the cut, not 0 where it is proven hidden from the eye's place; or empty.
void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible, double farM = std::numeric_limits<double>::infinity(),
                   std::span<const std::uint8_t> hidden = {});

/// Removes tiles by one flag a tile of `visible.tiles`, in order: 0 stays, 1 is proven hidden, 2 is proven
/// outside the view (by finer boxes than the index has).
void removeOccluded(const TerrainIndex& index, std::span<const std::uint8_t> flags, VisibleSet& visible);

}  // namespace trimtab
