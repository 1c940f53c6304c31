#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::experiment {

/// The error of a surface against the source triangles of a tile: vertical distances in metres of the
/// source's vertices from the surface and of its vertices from the source. Each place counts once, with equal
/// weight.
struct SurfaceError {
  std::uint64_t triangles = 0, bytes = 0;  ///< over the tile's ground; vertices and indices as uploaded
  double rmsM = 0, maxM = 0;
};

/// One level of the tree of document E, or all patches of one depth and variant.
struct BuilderLevel {
  std::uint32_t level = 0;  ///< level of the tree (0 is the root), or depth of the patches
  std::uint32_t variant = 0;
  SurfaceError error;
};
std::vector<BuilderLevel> treeLevels(const terrain::StaticLodTerrain& trees, std::size_t tile);
/// Returns the levels of patches, coarsest first, without depths that have no triangle in the tile. Returns
/// an empty list if a page cannot be read.
std::vector<BuilderLevel> patchLevels(const terrain::Database& terrain,
                                      const terrain::StaticLodTerrain& trees, std::size_t tile);
/// Returns what posts alone lose: the error of the bilinear surface of the posts at the source's vertices.
SurfaceError postsError(const terrain::Database& terrain, const terrain::StaticLodTerrain& trees,
                        std::size_t tile);

/// Returns the level with the most triangles, but no more than `triangles`. It is null if there is none.
const BuilderLevel* ofNoMoreTriangles(const std::vector<BuilderLevel>& levels, std::uint64_t triangles);
/// Returns the level with the fewest triangles whose RMS error is at most `rmsM` metres. Returns null if
/// there is none.
const BuilderLevel* ofNoGreaterRms(const std::vector<BuilderLevel>& levels, double rmsM);

}  // namespace trimtab::experiment
