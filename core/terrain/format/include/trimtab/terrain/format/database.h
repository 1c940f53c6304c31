#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/frame/ground_heights.h"
#include "trimtab/frame/terrain_index.h"
#include "trimtab/units/result.h"

/// A baked terrain: heights by level and an index, in one folder; opened read-only by any number of programs.
namespace trimtab::terrain {

/// A vertex as the renderer uploads it. Position: local frame, relative to the tile's origin, a multiple of
/// 1/256 m. Shared posts have the same position in every tile and level to the bit, so borders close exactly.
struct TileVertex {
  float x, y, z;
  std::int8_t normal[3];  ///< local frame, x 127
  std::uint8_t slope;  ///< steepest adjacent triangle of the finest level within two posts, 16 steps a unit,
                       ///< rounded up; 255: no bound
  std::uint8_t colour[4];  ///< sRGB + unused; land cover by slope and height, or the draped image
};
static_assert(sizeof(TileVertex) == 20);

/// (kTileCells + 1)^2 vertices, rows from south, and where the tile is.
struct TileMesh {
  static constexpr int kSide = TerrainIndex::kTileCells + 1;
  std::int32_t origin[3];            ///< multiples of 16 m in the local frame: metres = origin * 16
  std::vector<TileVertex> vertices;  ///< kSide * kSide
};

/// What FlightGear scenery holds; triangles are those that are drawn, without the degenerate.
struct SceneryCounts {
  std::uint32_t tiles = 0, airports = 0;
  std::uint64_t trianglesInFile = 0, degenerate = 0, triangles = 0;
  std::vector<std::string> missing;  ///< listed, but not there
};

/// What a terrain is, for `terrain info` and the title bar.
struct TerrainInfo {
  std::string name, source;
  GeodeticPosition southWest, northEast;
  std::uint32_t columns = 0, rows = 0;  ///< posts
  Degrees postLongitude, postLatitude;  ///< spacing
  Metres lowest, highest;
  std::uint64_t voidsFilled = 0;
  std::uint64_t bytes = 0;
  std::string checksum;  ///< of the database, over what it was made from and every file; hexadecimal
  bool hasImage = false;
  std::optional<SceneryCounts> scenery;  ///< where that was the source
};

struct StaticLodTerrain;
class GroundPyramid;
class PatchTerrain;

class Database : public GroundHeights {
 public:
  /// Opens a folder: reads indices, trees and a byte a cell of tiles' slopes, not heights, colours or meshes.
  /// Findings name file, place, expected and found; nothing half-open is returned.
  static Result<std::shared_ptr<const Database>> open(const std::filesystem::path& folder);

  virtual const TerrainInfo& info() const = 0;
  virtual const TerrainIndex& index() const = 0;
  /// Builds a node's vertices. Thread-safe; about 0.1 ms. The mesh's storage is reused.
  virtual void buildTile(std::uint32_t node, TileMesh& mesh) const = 0;
  /// The trees of static levels of detail, in the index's frame; null where the source was no scenery.
  virtual std::shared_ptr<const StaticLodTerrain> staticLod() const { return nullptr; }
  /// The error-bounded levels, in the index's frame; null in a database of an older version.
  virtual std::shared_ptr<const PatchTerrain> patches() const { return nullptr; }
  /// Colours and normals of the ground; null in a database of an older version.
  virtual std::shared_ptr<const GroundPyramid> ground() const { return nullptr; }
  /// Highest post within a distance, or none when no post is that near.
  virtual std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const = 0;
  /// Large files are checked where they are first touched: what was found to be damaged. There, no height is
  /// told and the lowest is drawn.
  virtual Findings damage() const { return {}; }
  /// Reads all of it, and what is wrong with it.
  virtual Findings checkAll() const { return {}; }
};

/// Whether a folder is a database, by its name for the manifest alone.
bool isDatabase(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
