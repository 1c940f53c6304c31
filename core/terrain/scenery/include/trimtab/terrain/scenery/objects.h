#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/host/placement_list.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// What stands on FlightGear scenery, from the lines of its lists (`.stg`).
struct SceneryObjects : PlacedModels {
  std::size_t shared = 0;                           ///< placements of models of the base package
  std::size_t own = 0;                              ///< placements of models beside the lists
  std::size_t signs = 0;                            ///< OBJECT_SIGN and OBJECT_SIGN_AGL, which are not drawn
  std::map<std::string, std::size_t> withoutModel;  ///< placements by the model that is not there
  std::map<std::string, std::size_t> others;        ///< lines by their first word, which are not read
};

/// Returns the folders that hold the base package's `Models`, in the order in which they are searched: the
/// one that is named, that of the environment variable FG_ROOT, and /usr/share/games/flightgear.
std::vector<std::filesystem::path> baseFolders(const std::optional<std::filesystem::path>& named);

/// Reads what the lists of some scenery place: OBJECT_SHARED and OBJECT_STATIC with path, longitude,
/// latitude (degrees), elevation (metres above mean sea level; of the forms with _AGL above the ground) and
/// heading, and if wanted pitch and roll. -9999 m, which scenery writes where it knew no elevation, is on the
/// ground. A shared model is looked for in `Models` and then in `Scenery/Models` of the scenery's own root
/// and of each base folder; others are files below the list's folder. A path that leads elsewhere, and a line
/// that cannot be used, is left out with a warning that names it; models that are not there are counted.
///
/// Source: FlightGear's Docs/README.scenery, sections 3.3 and 3.4: headings are anticlockwise. SimGear's
/// ReaderWriterSTG and makeZUpFrame: at heading 0 a model's x points south, y east and z up; it is turned by
/// roll about x, then by pitch about y, then by heading about z. A heading here is 90 degrees less
/// FlightGear's.
SceneryObjects readSceneryObjects(const std::filesystem::path& source,
                                  std::span<const std::filesystem::path> baseFolders, Findings& findings);

/// Returns notes of what stands on scenery, and of what is not drawn; none if its lists place nothing.
Findings aboutSceneryObjects(const std::filesystem::path& source, const SceneryObjects& objects);

}  // namespace trimtab::terrain
