#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/format/database.h"

/// What a tile hides, and what must be hidden for it to be left out. The proof is in occlusion.h.
namespace trimtab::scene {

constexpr int kOccluderStep = 2;  ///< every so-manyth post
constexpr int kOccluderSide = TerrainIndex::kTileCells / kOccluderStep + 1;
constexpr int kRing = 4 * (kOccluderSide - 1);
/// The posts row by row, then the border once more, lower: a wall all round, or rays would slip through
/// between tiles whose borders are lowered differently.
constexpr int kOccluderVertices = kOccluderSide * kOccluderSide + kRing;
constexpr int kPartsPerSide =
    4;  ///< a tile is tested as 4 x 4 boxes: one box pokes over the ridge that hides it
constexpr int kParts = kPartsPerSide * kPartsPerSide;

/// A vertex of the tile by every second post, put so low that no point of its triangles is above the tile as
/// drawn, whichever of its sides are stitched to coarser neighbours. `slope` bounds the drawn surface's (rise
/// over run against the geodetic vertical) over the triangles of this vertex and for OccluderLimits::reach
/// around them.
struct OccluderVertex {
  float x, y, z;
  float slope;
};

struct OccluderLimits {
  float reach = 0;     ///< metres round a triangle that its vertices' slopes hold for
  float farReach = 0;  ///< the same for `farSlope`
  float farSlope = 0;
  float edge = 0;  ///< a triangle's longest edge, seen from above
};

/// Box of a part of the tile, metres from the tile's origin.
struct PartBox {
  std::array<float, 4> low, high;  ///< x, y, z, unused
};

struct TileOccluder {
  std::vector<OccluderVertex> vertices;  ///< kOccluderVertices
  OccluderLimits limits;
  std::array<PartBox, kParts> parts;
};

/// Triangles of every occluder; counter-clockwise from above and from outside.
std::vector<std::uint16_t> makeOccluderIndices();

/// `slopeMax` is the index's for the node.
void makeOccluder(const terrain::TileMesh& mesh, float slopeMax, TileOccluder& occluder);

}  // namespace trimtab::scene
