#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

/// A tile or airport with the places of its vertices.
struct PlacedMesh {
  SceneryMesh mesh;
  std::vector<Vec3> places;  ///< per vertex: longitude and latitude in degrees, height in metres
};

/// Holds all tiles of some scenery. It keeps as many in memory as its budget allows, and reads or makes the
/// others again when they are needed.
class SceneryCatalogue {
 public:
  struct Tile {
    std::filesystem::path file;         ///< empty if it was not read from a file
    std::function<SceneryMesh()> make;  ///< makes it again; a tile with neither stays in memory
    std::string name;
    bool airport = false;
    Rectangle extent = Rectangle::none();  ///< of its triangles, degrees
  };

  /// Reads all sources once, and counts. A tile that two sources hold counts once. Fails if a tile is broken,
  /// because ground that is left out would look like sea or like a plain. Tiles may use `memory` bytes.
  static Result<std::unique_ptr<SceneryCatalogue>> open(std::span<const std::filesystem::path> sources,
                                                        std::size_t memory, const Progress& progress);
  /// Makes a catalogue of tiles that stay in memory.
  SceneryCatalogue(std::vector<SceneryMesh> meshes = {});

  /// Adds a tile. `again`, if given, must make the same tile, on any thread.
  void add(SceneryMesh mesh, std::function<SceneryMesh()> again = {}) {
    enter({}, std::move(again), std::move(mesh));
  }
  const std::vector<Tile>& tiles() const { return tiles_; }
  const SceneryCounts& counts() const { return counts_; }
  /// Returns the rectangle of all tiles, degrees.
  Rectangle extent() const;
  /// Returns the multiple of 360 degrees that brings this catalogue's longitudes nearest to `longitude`.
  double turnTo(double longitude) const;

  /// Returns a tile, read or made again if it is not in memory. Safe on any thread.
  Result<std::shared_ptr<const PlacedMesh>> mesh(std::size_t tile) const;
  /// Moves all tiles out, in order; the catalogue holds none afterwards. With texture coordinates, tiles of
  /// files are read again for them.
  Result<std::vector<SceneryMesh>> takeAll(bool withTexture = false);

 private:
  struct Slot {
    std::shared_ptr<PlacedMesh> mesh;
    std::size_t bytes = 0;
    std::uint64_t used = 0;
  };
  PlacedMesh placed(SceneryMesh mesh) const;
  void enter(std::filesystem::path file, std::function<SceneryMesh()> make, SceneryMesh mesh);
  Result<SceneryMesh> again(const Tile& tile, bool withTexture = false) const;
  void keep(std::size_t tile, std::shared_ptr<PlacedMesh> mesh) const;

  std::vector<Tile> tiles_;
  SceneryCounts counts_;
  double reference_ = 0;  ///< all longitudes lie within 180 degrees of it
  bool hasReference_ = false;
  std::size_t memory_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<Slot> slots_;  ///< per tile
  mutable std::size_t bytes_ = 0;    ///< of tiles that may be released
  mutable std::uint64_t use_ = 0;
};

}  // namespace trimtab::terrain
