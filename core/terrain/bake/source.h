#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "objects.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/scenery/import.h"

namespace trimtab::terrain {

/// Raise this with every change of the mesher, the patch sides or the tolerances: pieces that different
/// versions made do not fit together.
inline constexpr int kBuilderVersion = 12;

/// The opened sources of a bake: elevation, scenery, or scenery with elevation beside it.
struct BakeSource {
  std::optional<SceneryCounts> scenery;
  std::unique_ptr<SceneryCatalogue> tiles;  ///< null if no source is scenery
  std::uint64_t treesBytes = 0;             ///< memory that building the static LOD will need
  std::unique_ptr<ElevationSource> elevation;
  const SceneryHeights* heights = nullptr;  ///< `elevation` itself if a source is scenery, else null
  std::optional<Rectangle> between;         ///< area of the elevation beside scenery, degrees

  /// Returns the scenery's colour at each post, RGBA; empty if no source is scenery.
  Result<std::vector<std::uint8_t>> image(const Progress& progress) const;
  /// Makes tiles of `baked` where elevation has land and scenery has no tile. `baked` must outlive `tiles`.
  Result<Done> makeTiles(const HeightSource& baked, const Progress& progress);
};

/// Opens the sources; `memory`: most bytes that they may use.
Result<std::unique_ptr<BakeSource>> readSource(const BakeOptions& options, std::size_t memory,
                                               const Progress& progress);

/// Lists every file of the sources; folders are searched.
Result<std::vector<std::filesystem::path>> sourceFiles(const std::vector<std::filesystem::path>& sources);

/// Returns a JSON object of all that determines a database's bytes: source files, the options that matter,
/// and the checksums of placements and models if there are objects.
std::string recipeOf(const BakeOptions& options, const std::vector<std::filesystem::path>& files,
                     const std::optional<ObjectSources>& objects = {});
/// Returns recipeOf with the stamps of the files and the machine's arithmetic. A bake continues unfinished
/// work only if its stamped recipe is the same.
std::string stampedRecipe(const BakeOptions& options, const std::vector<std::filesystem::path>& files,
                          const std::optional<ObjectSources>& objects = {});
/// Tells whether two stamped recipes differ in the machine's arithmetic alone.
bool sameButForArithmetic(const std::string& stampedRecipe, const std::string& other);
/// Returns path, size and time of each file and of every file that GDAL reads with it, such as georeferences,
/// overviews and the parts of a virtual raster. Opens each file, and cannot be cancelled.
std::vector<std::string> stampsOf(std::span<const std::filesystem::path> files);

std::string joinedNames(const std::vector<std::filesystem::path>& sources);
std::string nameOf(const std::filesystem::path& path);

/// Limits GDAL's block cache to `bytes` while this object lives. GDAL's own limit is a share of the machine's
/// memory, which would break the memory limit of a bake.
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
