#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/frame/ground_heights.h"
#include "trimtab/frame/terrain_index.h"
#include "trimtab/units/result.h"

/// A baked terrain database: a folder that any number of programs may open read-only at the same time.
/// Format: resources/docs/terrain-format.md.
namespace trimtab::terrain {

/// A vertex as the renderer uploads it. The position is in the local frame, metres relative to the tile's
/// origin, a multiple of 1/256 m. A post has the same position, to the bit, in every tile and level, so that
/// borders have no cracks.
struct TileVertex {
  float x, y, z;
  std::int8_t normal[3];  ///< local frame, x 127
  std::uint8_t slope;  ///< steepest adjacent triangle of the finest level within two posts, 16 steps a unit,
                       ///< rounded up; 255: no bound
  std::uint8_t colour[4];  ///< sRGB + unused; land cover by slope and height, or the draped image
};
static_assert(sizeof(TileVertex) == 20);

/// The (kTileCells + 1)^2 vertices of a tile, rows from south, and its origin.
struct TileMesh {
  static constexpr int kSide = TerrainIndex::kTileCells + 1;
  std::int32_t origin[3];            ///< multiples of 16 m in the local frame: metres = origin * 16
  std::vector<TileVertex> vertices;  ///< kSide * kSide
};

/// Contents of FlightGear scenery. `triangles` counts those that are drawn, without the degenerate ones.
struct SceneryCounts {
  std::uint32_t tiles = 0, airports = 0;
  std::uint64_t trianglesInFile = 0, degenerate = 0, triangles = 0;
  std::vector<std::string> missing;  ///< files that an .stg file lists, but that do not exist
};

/// Facts about a terrain, for `terrain info` and the title bar.
struct TerrainInfo {
  std::string name, source;
  GeodeticPosition southWest, northEast;
  std::uint32_t columns = 0, rows = 0;  ///< posts
  Degrees postLongitude, postLatitude;  ///< spacing
  Metres lowest, highest;
  std::uint64_t voidsFilled = 0;
  std::uint64_t bytes = 0;
  std::string checksum;  ///< over the recipe and every file of the database; hexadecimal
  bool hasImage = false;
  std::optional<SceneryCounts> scenery;  ///< unset if no source was scenery
};

struct ObjectTerrain;
struct StaticLodTerrain;
class GroundPyramid;
class PatchTerrain;
struct ObjectTerrain;

/// An open database. All functions are const and thread-safe.
class Database : public GroundHeights {
 public:
  /// Opens a folder. Reads the indices, the static LOD, the objects and the slopes of tiles (a byte per
  /// cell); heights, colours and meshes are read when they are used. On failure returns findings with file,
  /// place, expected and found.
  static Result<std::shared_ptr<const Database>> open(const std::filesystem::path& folder);

  virtual const TerrainInfo& info() const = 0;
  std::optional<Metres> highest() const override { return info().highest; }
  virtual const TerrainIndex& index() const = 0;
  /// Builds a node's vertices; about 0.1 ms. Reuses the storage of `mesh`.
  virtual void buildTile(std::uint32_t node, TileMesh& mesh) const = 0;
  /// Returns the static LOD, in the index's frame; null if no source was scenery.
  virtual std::shared_ptr<const StaticLodTerrain> staticLod() const { return nullptr; }
  /// Returns the error-bounded patches, in the index's frame; null in a database of version 1.
  virtual std::shared_ptr<const PatchTerrain> patches() const { return nullptr; }
  /// Returns colours and normals of the ground; null in a database of version 1.
  virtual std::shared_ptr<const GroundPyramid> ground() const { return nullptr; }
  /// Returns what stands on the ground, in the index's frame; null if nothing does.
  virtual std::shared_ptr<const ObjectTerrain> objects() const { return nullptr; }
  /// Returns the height of the highest post within `radius`, or none if no post is that near.
  virtual std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const = 0;
  /// Returns the damage found so far; large files are checked as they are read. In a damaged block heights
  /// are unknown, and the terrain's lowest height is drawn; where a page is damaged, a coarser form is.
  virtual Findings damage() const { return {}; }
  /// Reads the whole database and returns all damage.
  virtual Findings checkAll() const { return {}; }
};

/// Tells whether a folder has a manifest. It does not read the manifest.
bool isDatabase(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
