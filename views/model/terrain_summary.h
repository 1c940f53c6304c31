// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cstdint>
#include <vector>

namespace trimtab::views {

/// One level of a terrain: 0 is the finest level of tiles, but the coarsest depth of patches.
struct TerrainLevel {
  std::uint64_t nodes = 0, triangles = 0;  ///< triangles of the finest meshes of all nodes
  std::uint64_t bytes = 0;                 ///< on disk; 0 if it is made when it is drawn
  double maxErrorM = 0, rmsErrorM = 0;     ///< at the posts; NaN if not measured
  double surfaceErrorM = 0;                ///< the worst between the posts; NaN if not measured
};

/// What the dock shows about a terrain.
struct TerrainSummary {
  QString name, source;
  bool osgScene = false;  ///< drawn by OpenSceneGraph as it is: it has no posts and no levels of ours
  std::uint64_t columns = 0, rows = 0, voidsFilled = 0, bytes = 0;
  double postM = 0;  ///< distance of posts along a meridian
  double lowestM = 0, highestM = 0, southDeg = 0, westDeg = 0, northDeg = 0, eastDeg = 0;
  std::vector<TerrainLevel> tiles, patches;  ///< empty if it has none
};

}  // namespace trimtab::views
