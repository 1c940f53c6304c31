#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/terrain_frame.h"
#include "trimtab/frame/visible_set.h"
#include "trimtab/preset/parameters.h"

/// What drawing one image did, and what it cost.
namespace trimtab {

struct FrameResult {
  VisibleSet visible;
  FrameCost cost;  ///< milliseconds; gpu is NaN where there is no timer query yet
  std::size_t tilesInCut = 0;
  bool patches = false;  ///< the nodes of `visible` are patches
  PagingFrame paging;
  StaticLodFrame staticLod;              ///< where `drawn`, the nodes of `visible` are the trees'
  std::optional<DepthMapSize> depthMap;  ///< of the map that had a part in `visible`; none: none had
  bool horizon = false;                  ///< one had a part in `visible`
  /// What looks for hidden ground in this frame; none: nothing does. Never `automatic`. It may leave out its
  /// horizon or map, as one hid next to nothing near here.
  std::optional<OcclusionMethod> occlusion;
  /// Why occlusion was not used as asked for, and what serves instead: sentences; empty otherwise.
  std::string note;
  // Counters of work that was skipped or done, since the renderer was made.
  std::uint64_t precipitationPasses = 0, blurPasses = 0, symbologyDraws = 0, symbologyRedraws = 0;
  std::uint64_t depthMapsDrawn = 0, horizonsBuilt = 0, cutsSelected = 0, tilesBuilt = 0;
  std::uint64_t horizonsLeftOut = 0;  ///< because it hid next to nothing a little way off: nothing is hidden
  std::uint64_t horizonsMoved = 0;    ///< taken along with the eye instead of being built
  std::uint64_t mapsDrawnByCpu = 0;
  std::uint64_t mapsLeftOut = 0;        ///< of the processor, as horizons are
  std::uint64_t occlusionsLeftOut = 0;  ///< because no method was worth its cost
  std::uint64_t visibleSelected = 0;    ///< visible sets that were chosen anew
};

}  // namespace trimtab
