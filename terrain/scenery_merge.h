#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "trimtab/terrain/scenery_import.h"

namespace trimtab::terrain {

struct MergedScenery {
  HeightGrid grid;  ///< no voids left
  std::uint64_t voidsFilled = 0;
  std::unique_ptr<SceneryCatalogue> tiles;  ///< all of it in memory
  SceneryCounts counts;
};

/// Scenery and elevation side by side on one grid of posts over both: scenery's triangles where there are
/// any, elevation elsewhere, blended so that no step shows. `tiles` has scenery's tiles and, for buckets
/// without one, tiles made of the grid that share its borders, so that trees close between both kinds;
/// `counts` has scenery's alone. Airports sit in their holes as ever.
///
/// Posts are as close as the finer of the two has them, where no distance is given; all of them are in
/// memory.
Result<MergedScenery> importMerged(std::span<const std::filesystem::path> scenery,
                                   std::span<const std::filesystem::path> elevation,
                                   std::optional<Metres> distance, const Progress& progress);

/// The same of what was read. `elevation`: heights with NaN for none.
Result<MergedScenery> merged(std::unique_ptr<SceneryCatalogue> scenery, const HeightGrid& elevation,
                             std::optional<Metres> distance, const Progress& progress);

}  // namespace trimtab::terrain
