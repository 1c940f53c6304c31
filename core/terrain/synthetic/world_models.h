#pragma once

#include <filesystem>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// The models of the sample's world, in the order of kWorldModelNames.
enum class WorldModel {
  fir,
  spruce,
  pine,
  oak,
  birch,
  poplar,
  bush,
  house,
  largeHouse,
  flats,
  church,
  hangar,
  controlTower,
  pylon,
  // Lights without a mesh.
  runwayLight,
  thresholdLight,
  runwayEndLight,
  streetLight
};
inline constexpr const char* kWorldModelNames[] = {"fir",
                                                   "spruce",
                                                   "pine",
                                                   "oak",
                                                   "birch",
                                                   "poplar",
                                                   "bush",
                                                   "house",
                                                   "large-house",
                                                   "flats",
                                                   "church",
                                                   "hangar",
                                                   "control-tower",
                                                   "pylon",
                                                   "runway-light",
                                                   "threshold-light",
                                                   "runway-end-light",
                                                   "street-light"};

/// Writes NAME.obj for each of them, and the colours that they share, into a folder that is made if there is
/// none. Metres, y up, the front towards -z; closed meshes, anticlockwise from outside.
Result<Done> writeWorldModels(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
