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

/// A tile or airport and where its vertices are.
struct PlacedMesh {
  SceneryMesh mesh;
  std::vector<Vec3> places;  ///< longitude, latitude (degrees) and height (metres), one a vertex
};

/// All tiles of some scenery. Those that came from files are read again when they are needed, and those that
/// can be made again are: as many stay in memory as it was given.
class SceneryCatalogue {
 public:
  struct Tile {
    std::filesystem::path file;         ///< empty: it was not read from one
    std::function<SceneryMesh()> make;  ///< the same again; neither: it stays in memory
    std::string name;
    bool airport = false;
    Rectangle extent = Rectangle::none();  ///< of its triangles
  };

  /// Reads all of the sources once, and counts. A tile that two of them hold counts once. Refused where one
  /// is broken: ground that it leaves out would look like sea or like a plain. `memory`: bytes that tiles may
  /// take.
  static Result<std::unique_ptr<SceneryCatalogue>> open(std::span<const std::filesystem::path> sources,
                                                        std::size_t memory, const Progress& progress);
  /// Of tiles that stay in memory; a vector of them is a catalogue where one is asked for.
  SceneryCatalogue(std::vector<SceneryMesh> meshes = {});

  /// `again`, where it can be made again: the same, on any thread.
  void add(SceneryMesh mesh, std::function<SceneryMesh()> again = {}) {
    enter({}, std::move(again), std::move(mesh));
  }
  const std::vector<Tile>& tiles() const { return tiles_; }
  const SceneryCounts& counts() const { return counts_; }
  /// Of all tiles.
  Rectangle extent() const;
  /// Turns, in degrees, that take this catalogue's longitudes next to one.
  double turnTo(double longitude) const;

  /// Any thread.
  Result<std::shared_ptr<const PlacedMesh>> mesh(std::size_t tile) const;
  /// All of them, in their order; the catalogue's own copies are gone then.
  Result<std::vector<SceneryMesh>> takeAll();

 private:
  struct Slot {
    std::shared_ptr<PlacedMesh> mesh;
    std::size_t bytes = 0;
    std::uint64_t used = 0;
  };
  PlacedMesh placed(SceneryMesh mesh) const;
  void enter(std::filesystem::path file, std::function<SceneryMesh()> make, SceneryMesh mesh);
  Result<SceneryMesh> again(const Tile& tile) const;
  void keep(std::size_t tile, std::shared_ptr<PlacedMesh> mesh) const;

  std::vector<Tile> tiles_;
  SceneryCounts counts_;
  double reference_ = 0;  ///< longitudes lie within half a turn of it
  bool hasReference_ = false;
  std::size_t memory_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<Slot> slots_;  ///< one a tile
  mutable std::size_t bytes_ = 0;    ///< of those that need not stay
  mutable std::uint64_t use_ = 0;
};

}  // namespace trimtab::terrain
