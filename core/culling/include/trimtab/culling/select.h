#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/cut_rule.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"
#include "trimtab/frame/visible_set.h"

/// Selects the nodes that a frame draws and their levels, and records for every other node why it is not
/// drawn. resources/docs/levels-of-detail.md explains the error measure.
namespace trimtab {

/// A LOD cut: the tiles, patches or nodes of static trees that together cover the terrain once, each at its
/// level, for one eye position. It does not depend on the view direction or on culling, so culling cannot
/// change what a drawn node looks like. Neighbouring tiles differ by at most one level.
struct LevelCut {
  std::vector<TileDraw> tiles;  ///< selectors choose an order that depends on the terrain only

  // selectVisible reads these beside the tiles; `gather` computes them.
  BoxArrays boxes;                                    ///< bounds of each tile
  BoxArrays blockBoxes;                               ///< bounds of each block of BoxArrays::kBlock tiles
  std::vector<std::uint32_t> triangles;               ///< drawn for each tile
  std::vector<std::uint64_t> blockTriangles;          ///< drawn for each block
  std::vector<NormalCone> cones;                      ///< of each tile; empty if the index has none
  std::vector<std::int16_t> blockSteepness;           ///< largest steepness (back_facing.h) in each block
  std::shared_ptr<std::vector<std::uint32_t>> nodes;  ///< a new list while a visible set holds it

  // Working storage of selectLevels, kept from frame to frame.
  std::vector<std::uint8_t> split;                     ///< one per node: 1 if its children are drawn instead
  std::vector<std::vector<std::uint32_t>> splitNodes;  ///< by level
  std::vector<std::uint32_t> stack;
};

/// Fills `cut` with tiles whose screen-space error at `eye` is what the rule accepts where the data allow it,
/// restricted so that neighbours differ by one level at most.
void selectLevels(const TerrainIndex& index, Vec3 eye, const CutRule& rule, LevelCut& cut);

/// Computes the rest of a cut from its tiles. selectLevels calls it.
void gather(const TerrainIndex& index, LevelCut& cut);

/// Holds what selectVisible tests the nodes of a cut against.
struct VisibleQuery {
  EyePose eye = {};
  ViewShape view = {};
  bool cull = true;  ///< false draws the whole cut but for `hidden` (culling case *none*)
  /// Nodes wholly beyond the sphere of this radius around the eye are left out, metres. Document D moves the
  /// far plane instead; with a sphere a turn of the head does not move the far cut, and fog depends on the
  /// same distance.
  double farM = std::numeric_limits<double>::infinity();
  std::span<const std::uint8_t> hidden = {};  ///< a flag per node, not 0 if hidden; fewer are ignored
  /// Leaves out nodes all of whose triangles face away; back_facing.h says when that is allowed.
  bool backFaces = false;
};

/// Fills `visible` with the nodes of any cut that pass the query; the frustum has no far plane. It keeps
/// every node that owns a pixel within `farM`, and does not count vertices.
void selectVisible(const LevelCut& cut, const VisibleQuery& query, VisibleSet& visible);

/// Removes nodes from `visible` by one flag per node of `visible.tiles`, in order: 0 keeps it, 1 says it is
/// proven hidden, 2 that it is proven outside the view. Nodes beyond the flags stay. Does not count vertices.
void removeOccluded(const LevelCut& cut, std::span<const std::uint8_t> flags, VisibleSet& visible);

/// Returns the vertices of a visible set of square tiles.
std::uint64_t tileVertices(const VisibleSet& visible);

}  // namespace trimtab
