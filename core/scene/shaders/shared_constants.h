#pragma once

#include "trimtab/frame/terrain_index.h"

/// Sizes on which C++ and the shaders agree. shaders.cpp writes them into each shader, with those of light.h.
namespace trimtab::scene {

inline constexpr int kTileVertices = (TerrainIndex::kTileCells + 1) * (TerrainIndex::kTileCells + 1);
/// Vertices per texel of the texture that says where a patch, or a node of a static tree, lies.
inline constexpr int kPatchBlock = 32, kTreeBlock = 64;

/// An occluder uses every second post of its tile: first the posts row by row, then the border again, lower.
/// That makes a wall around the tile, without which rays would pass between tiles whose borders are lowered
/// differently.
inline constexpr int kOccluderStep = 2;
inline constexpr int kOccluderSide = TerrainIndex::kTileCells / kOccluderStep + 1;
inline constexpr int kRing = 4 * (kOccluderSide - 1);
inline constexpr int kOccluderVertices = kOccluderSide * kOccluderSide + kRing;

/// A tile is tested as 4 x 4 boxes, because a single box would stand out above the ridge that hides the tile.
inline constexpr int kPartsPerSide = 4;
inline constexpr int kParts = kPartsPerSide * kPartsPerSide;
/// Tiles per row of the image into which the GPU writes the results of its tests.
inline constexpr int kTestedPerRow = 64;

/// Side of a layer of the ground's colours, texels; a power of two.
inline constexpr int kGroundSide = 1024;

}  // namespace trimtab::scene
