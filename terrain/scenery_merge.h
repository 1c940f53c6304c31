#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "trimtab/terrain/scenery_import.h"

namespace trimtab::terrain {

/// Scenery and elevation side by side on one grid of posts over both: scenery's triangles where there are
/// any, elevation elsewhere, blended so that no step shows. `meshes` has scenery's tiles and, for buckets
/// without one, tiles made of the grid that share its borders, so that trees close between both kinds;
/// `counts` has scenery's alone. Airports sit in their holes as ever.
///
/// Posts are as close as the finer of the two has them, where no distance is given; all of them are in
/// memory.
Result<ImportedScenery> importMerged(std::span<const std::filesystem::path> scenery,
                                     std::span<const std::filesystem::path> elevation,
                                     std::optional<Metres> distance, const Progress& progress);

/// The same of what was read. `elevation`: heights with NaN for none.
Result<ImportedScenery> merged(Scenery scenery, const HeightGrid& elevation, std::optional<Metres> distance,
                               const Progress& progress);

}  // namespace trimtab::terrain
