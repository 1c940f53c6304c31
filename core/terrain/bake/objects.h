#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// What objects of a bake are made from: the placements, and the models that they name.
struct ObjectSources {
  std::filesystem::path file;  ///< of the placements, or the first source with objects
  bool required = false;       ///< a person named a list of them: it is an error if nothing can be placed
  std::uint64_t sum = 0;       ///< checksum of what they say
  PlacementList list;
  std::vector<std::optional<SourceModel>> models;  ///< one per name of the list; none if it cannot be read
  std::vector<std::uint64_t> modelSums;            ///< of what each holds; 0 for none
};

/// Returns what a source brings to stand on it: features of a CDB, objects of scenery; else nothing.
PlacedModels placedOn(const std::filesystem::path& source,
                      const std::optional<std::filesystem::path>& sceneryModels, Findings& findings);

/// Reads placements and models: of the list that the options name, and those that the sources bring. Returns
/// none if there are no placements. A model that cannot be read is a warning. None at all is an error if a
/// list was named, and so is more of them than `memory` bytes hold while they are placed.
Result<std::optional<ObjectSources>> readObjectSources(const BakeOptions& options, std::size_t memory);

/// Makes levels of all models and puts them on the ground; nothing, with warnings, if nothing that sources
/// bring can be placed: `patches`, the finished file of a database with the baked `heights`, says where it is
/// drawn. Takes the models out of `sources`.
Result<ObjectTerrain> bakeObjects(ObjectSources& sources, const HeightSource& heights,
                                  const std::filesystem::path& patches, const LocalFrame& frame,
                                  const Progress& progress);

}  // namespace trimtab::terrain
