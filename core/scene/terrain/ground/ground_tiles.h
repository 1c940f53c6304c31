#pragma once

#include <condition_variable>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "trimtab/terrain/format/ground_pyramid.h"

namespace trimtab::scene {

/// A tile as the texture has it: sRGB, and in alpha the light on it as a share of kMostLight.
using GroundPixels = std::vector<std::uint32_t>;

/// The colour, sRGB, of filled voids if they are shown.
inline constexpr std::uint8_t kVoidColour[3] = {204, 121, 167};

GroundPixels litGround(const terrain::GroundTile& tile, bool showVoids);

/// Reads tiles of the ground ahead on a thread of its own and keeps those last used. All calls may come from
/// any thread.
class GroundTiles {
 public:
  /// Tiles of 256 KB: the borders of a dozen levels, and those on their way.
  static constexpr std::size_t kKept = 96;

  GroundTiles(std::shared_ptr<const terrain::GroundPyramid> ground, bool showVoids);
  ~GroundTiles();
  GroundTiles(const GroundTiles&) = delete;
  GroundTiles& operator=(const GroundTiles&) = delete;

  struct Tile {
    std::uint32_t level = 0, column = 0, row = 0;
    std::uint64_t key() const { return terrain::groundKey(level, column, row); }
  };
  /// Returns a tile; null while it is not read. A tile that cannot be read is made from the level above.
  std::shared_ptr<const GroundPixels> find(const Tile& tile);
  /// Returns a tile, and reads it now if necessary.
  std::shared_ptr<const GroundPixels> readNow(const Tile& tile);
  /// Sets what the thread reads, the most urgent first.
  void want(std::vector<Tile> tiles);

  std::size_t bytes() const;
  std::size_t failed() const;  ///< tiles; none is tried again
  /// Returns the first failures.
  Findings failures() const;

 private:
  struct Entry {
    std::shared_ptr<const GroundPixels> pixels;
    std::list<std::uint64_t>::iterator use;
    bool taken = false;
  };

  std::shared_ptr<const GroundPixels> load(const Tile& tile);
  std::shared_ptr<const GroundPixels> fromCoarser(const Tile& tile);
  void keep(std::uint64_t key, std::shared_ptr<const GroundPixels> pixels, bool taken);
  void run();

  std::shared_ptr<const terrain::GroundPyramid> ground_;
  bool showVoids_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Tile> wanted_;  ///< the most urgent last
  std::unordered_set<std::uint64_t> wantedKeys_;
  std::unordered_map<std::uint64_t, Entry> entries_;
  std::list<std::uint64_t> uses_;  ///< last used first
  std::size_t untaken_ = 0;
  std::unordered_set<std::uint64_t> failed_;
  Findings failures_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace trimtab::scene
