#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/scenery/import.h"

namespace trimtab::terrain {

/// To be raised with every change of the mesher, sides or tolerances: pieces that different programs made do
/// not fit together.
inline constexpr int kBuilderVersion = 10;

/// What the sources hold, by either import.
struct BakeSource {
  std::optional<SceneryCounts> scenery;
  std::unique_ptr<SceneryCatalogue> tiles;  ///< of scenery; null without
  std::uint64_t treesBytes = 0;             ///< that making their trees will take
  std::unique_ptr<ElevationSource> elevation;
  const SceneryHeights* heights = nullptr;  ///< the same, where it is scenery
  std::optional<Rectangle> between;         ///< what elevation has, where it lies beside scenery

  /// Scenery's colours at its posts, RGBA; empty without scenery.
  Result<std::vector<std::uint8_t>> image(const Progress& progress) const;
  /// Those between scenery's, of the heights of both; `baked` must live as long as tiles are asked for.
  Result<Done> makeTiles(const HeightSource& baked, const Progress& progress);
};

/// `memory`: bytes that it may take.
Result<std::unique_ptr<BakeSource>> readSource(const BakeOptions& options, std::size_t memory,
                                               const Progress& progress);

/// Every file of the sources.
Result<std::vector<std::filesystem::path>> sourceFiles(const std::vector<std::filesystem::path>& sources);

/// What a database is made from, a JSON object: of the options, those that change a byte of it.
std::string recipeOf(const BakeOptions& options, const std::vector<std::filesystem::path>& files);
/// The same with places and times and what the machine's arithmetic is: another one begins a bake anew.
std::string stampedRecipe(const BakeOptions& options, const std::vector<std::filesystem::path>& files);
/// Whether two of those differ in nothing but the machines that they were made on.
bool sameButForArithmetic(const std::string& stampedRecipe, const std::string& other);
/// Place, size and time of each file, and of all that GDAL reads with it: what says where the raster is, its
/// overviews, the rasters that a virtual one is made of. Opens each; cannot be stopped.
std::vector<std::string> stampsOf(std::span<const std::filesystem::path> files);

std::string joinedNames(const std::vector<std::filesystem::path>& sources);
std::string nameOf(const std::filesystem::path& path);

/// GDAL keeps no more than so much of the rasters that it reads, bytes, while this lives: its own limit is a
/// share of the machine's memory.
class RasterCacheLimit {
 public:
  explicit RasterCacheLimit(std::size_t bytes);
  ~RasterCacheLimit();
  RasterCacheLimit(const RasterCacheLimit&) = delete;
  RasterCacheLimit& operator=(const RasterCacheLimit&) = delete;

 private:
  std::int64_t before_;
};

}  // namespace trimtab::terrain
