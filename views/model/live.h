// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/terrain_frame.h"

namespace trimtab::views {

/// One frame as the docks see it. Widgets take it by `showFrame(const LiveFrame&)`: cheap enough for every
/// frame, as they repaint at most some 30 times a second and not at all while hidden. Logs and plots record
/// hidden or not.
struct LiveFrame {
  double time = 0;  ///< seconds on any clock that rises; one clock a session
  std::uint64_t packet = 0;
  FrameDecision decision;
  FrameCost cost;  ///< NaN: not run or not measured
  std::uint64_t triangles = 0, vertices = 0;
  std::size_t tilesDrawn = 0, tilesInCut = 0, outsideFrustum = 0, occluded = 0, beyondVisibility = 0,
              backFacing = 0;
  double fps = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t blurPasses = 0, symbologyDraws = 0, symbologyRedraws = 0;  ///< since the context was made
  StaticLodFrame staticLod;
  bool patches = false;  ///< were drawn: `levels` is by their depth
  LevelsFrame levels;
  PagingFrame paging;
  std::optional<DepthMapSize> depthMap;      ///< of the map that had a part in what is drawn
  bool horizon = false;                      ///< one had a part in it
  std::optional<OcclusionMethod> occlusion;  ///< what looks for hidden ground; none: nothing does
  std::string cullingNote;  ///< why it is not as asked for, and what serves instead: sentences; or empty
  // So far.
  std::uint64_t cutsSelected = 0, visibleSelected = 0, horizonsBuilt = 0, horizonsMoved = 0,
                horizonsLeftOut = 0, depthMapsDrawn = 0, mapsDrawnByCpu = 0, mapsLeftOut = 0,
                occlusionsLeftOut = 0;
  std::optional<HostWeather> hostWeather;  ///< as the host, or the flight, says
  std::optional<Metres> hostVisibility;
};

}  // namespace trimtab::views
