#pragma once

#include <cstdint>
#include <filesystem>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/scenery/write.h"

/// Writes one level of the static trees back as FlightGear scenery: document E's unfinished integration.
namespace trimtab::terrain {

/// Returns what is drawn of a tile at a level, as surfaceOfLevel() has it, as a tile of scenery. Normals are
/// those of the tree. Texture coordinates are the tree's if it has some, else textureByPlace().
BtgSurface btgOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level);

struct SceneryExport {
  std::uint32_t level = 0;       ///< 0 is the roots; leaves above it are written where a tree is less deep
  std::filesystem::path output;  ///< a folder that does not exist, or is empty
  Progress progress;             ///< returning false cancels; nothing is left behind
};
struct SceneryExported {
  std::uint64_t tiles = 0, airports = 0, lists = 0, triangles = 0, bytes = 0;
  std::uint64_t seas = 0;               ///< trees of open sea, which are left out
  double rmsErrorM = 0, maxErrorM = 0;  ///< the largest that a written node states, vertical
};
/// Writes `Terrain/e000n50/e007n50/3072816.btg.gz` and so on, and an `.stg` list for each bucket. A tree that
/// has not a bucket's number for a name (an airport) is listed by the bucket that holds its middle. Open sea
/// (withOpenSea) is left out, because FlightGear makes sea itself where there is no tile. The folder appears
/// when all of it is written. Refuses a level that no tree has, two tiles of one name in one folder, and an
/// output that holds something; `where` names the terrain in findings.
Result<SceneryExported> exportScenery(const StaticLodTerrain& terrain, const SceneryExport& options,
                                      const std::string& where);

}  // namespace trimtab::terrain
