#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/scene/shaders/shared_constants.h"
#include "trimtab/terrain/format/database.h"

/// The lowered copy of a tile that may hide others, and the boxes that must be hidden before the tile itself
/// may be left out. resources/docs/occlusion.md has the proof.
namespace trimtab::scene {

/// A vertex of an occluder, metres from the tile's origin. It is so low that no point of its triangles is
/// above the tile as drawn, whichever of the tile's sides are stitched to coarser neighbours. `slope` is an
/// upper bound of the drawn surface's slope (rise over run against the geodetic vertical) over the triangles
/// of this vertex and within OccluderLimits::reach of them.
struct OccluderVertex {
  float x, y, z;
  float slope;
};

struct OccluderLimits {
  float reach = 0;     ///< metres around a triangle within which its vertices' slopes hold
  float farReach = 0;  ///< metres around a triangle within which farSlope holds
  float farSlope = 0;
  float edge = 0;  ///< longest edge of any triangle in plan, metres
};

/// The box of a part of the tile, metres from the tile's origin.
struct PartBox {
  std::array<float, 4> low, high;  ///< x, y, z, unused
};

struct TileOccluder {
  std::vector<OccluderVertex> vertices;  ///< kOccluderVertices
  OccluderLimits limits;
  std::array<PartBox, kParts> parts;
};

/// Returns the triangles that all occluders share, counter-clockwise from above and from outside.
std::vector<std::uint16_t> makeOccluderIndices();

/// Fills `occluder` from a tile's mesh. `slopeMax` is the index's for the node.
void makeOccluder(const terrain::TileMesh& mesh, float slopeMax, TileOccluder& occluder);

}  // namespace trimtab::scene
