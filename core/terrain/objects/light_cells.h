#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/frame/light_index.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/objects/build_model.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/linear.h"

namespace trimtab::terrain {

/// A light of the terrain before it is in a cell.
struct PlacedLight {
  Vec3 place;  ///< in the local frame
  std::array<std::uint8_t, 4> colour{};
};

/// Returns for each model how far its farthest light is from its origin, metres at scale 1; -1 for one whose
/// lights are not placed. These are models without lights, and those whose lights, once for each row that
/// names them, would be more than ObjectLimits::kLights together with those of the models before: a finding
/// names each.
std::vector<double> reachesOfLights(std::span<const std::optional<BuiltModel>> models,
                                    const PlacementList& list, const std::string& where,
                                    FindingList& findings);

/// Sorts lights into cells of neighbours.
LightIndex lightsInCells(std::vector<PlacedLight> lights);

}  // namespace trimtab::terrain
