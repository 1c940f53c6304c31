#pragma once

#include <optional>
#include <span>
#include <string>

#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A cell of at most so many instances, or of so small a side, is not divided.
inline constexpr std::uint32_t kLeafInstances = 32;
inline constexpr double kLeafSideM = 16;

/// Puts models on the ground: instances in a quadtree over x and y of `frame`, cells depth first, instances
/// of a leaf by model. A thing stands upright at its place on the curved earth, turned by its heading, its
/// origin at the placement's height, else on `ground`. Boxes of cells hold all levels of all instances as
/// they are drawn, with turns and places rounded to what is stored.
///
/// `models`: one per `list.models`; none for one that cannot be used. `where` names the placements in
/// findings. Three kinds of placements are left out: those off the ground and those that their scale makes
/// larger than ObjectLimits::kRadiusM, with a warning for each row (the first FindingList::kMost, then their
/// number), and those of models that are none, with one for each model. Fails if none is left, if the models'
/// meshes outgrow what indices can count, or if `progress` says so. Lights of a model are placed with it; a
/// model that would bring a terrain beyond ObjectLimits::kLights is placed without, with a warning. Of more
/// than 255 textures the last ones become their average colour, with a warning.
Result<ObjectTerrain> buildObjects(std::span<const std::optional<BuiltModel>> models,
                                   const PlacementList& list, const GroundHeights& ground,
                                   const LocalFrame& frame, const std::string& where,
                                   const Progress& progress = {});

}  // namespace trimtab::terrain
