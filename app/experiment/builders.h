#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::experiment {

/// A surface held against the source triangles of a tile: vertical distances, metres, of the source's
/// vertices from it and of its vertices from the source, each place once and all of one weight.
struct SurfaceError {
  std::uint64_t triangles = 0, bytes = 0;  ///< over the tile's ground; vertices and indices as uploaded
  double rmsM = 0, maxM = 0;
};

/// One level of document E's tree; or all patches of one depth in one variant.
struct BuilderLevel {
  std::uint32_t level = 0;  ///< of the tree, the root's 0; or the depth
  std::uint32_t variant = 0;
  SurfaceError error;
};
std::vector<BuilderLevel> treeLevels(const terrain::StaticLodTerrain& trees, std::size_t tile);
/// Coarsest first; nothing where a page cannot be read. Depths that give the tile no triangle are left out.
std::vector<BuilderLevel> patchLevels(const terrain::Database& terrain,
                                      const terrain::StaticLodTerrain& trees, std::size_t tile);
/// What posts alone lose: the source's vertices against the bilinear surface of the database's posts.
SurfaceError postsError(const terrain::Database& terrain, const terrain::StaticLodTerrain& trees,
                        std::size_t tile);

/// Of `levels` the one with the most triangles that has no more than so many; null: none has.
const BuilderLevel* ofNoMoreTriangles(const std::vector<BuilderLevel>& levels, std::uint64_t triangles);
/// The one with the fewest triangles and no greater RMS; null: none has.
const BuilderLevel* ofNoGreaterRms(const std::vector<BuilderLevel>& levels, double rmsM);

}  // namespace trimtab::experiment
