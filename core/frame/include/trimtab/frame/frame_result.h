#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/object_frame.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/terrain_frame.h"
#include "trimtab/frame/visible_set.h"
#include "trimtab/preset/parameters.h"

/// Declares what drawing one image did, and what it cost.
namespace trimtab {

/// Counts how often each kind of work was done. A stage returns what it did in one frame;
/// FrameResult::counters is the sum since the renderer was made.
struct FrameCounters {
  std::uint64_t precipitationPasses = 0, blurPasses = 0, symbologyDraws = 0;
  std::uint64_t particlesDrawn = 0;      ///< drops and flakes of PrecipitationForm::bounded
  std::uint64_t symbologyRedraws = 0;    ///< draws whose symbols had changed
  std::uint64_t hostSymbolsLeftOut = 0;  ///< not drawn in a redraw, because they have no surface, too many
                                         ///< ancestors, or too many strokes
  std::uint64_t cutsSelected = 0, visibleSelected = 0, tilesBuilt = 0;
  std::uint64_t tilesBuiltAhead = 0;  ///< between images (Renderer::buildAhead), and not in tilesBuilt
  std::uint64_t depthMapsDrawn = 0;
  std::uint64_t horizonsBuilt = 0;
  std::uint64_t horizonsMoved = 0;    ///< moved along with the eye instead of being built
  std::uint64_t horizonsLeftOut = 0;  ///< not built, because near here one hid next to nothing
  std::uint64_t occlusionsLeftOut =
      0;  ///< frames without occlusion, because the horizon was not worth its cost

  FrameCounters& operator+=(const FrameCounters& other);
  friend bool operator==(const FrameCounters&, const FrameCounters&) = default;
};

/// Says what looked for hidden ground in one frame, and what came of it.
struct OcclusionResult {
  std::optional<OcclusionResolution>
      depthMap;          ///< size of the depth map that shaped `visible`; unset if none did
  bool horizon = false;  ///< a horizon shaped `visible`
  /// The method in use, never `automatic`; unset if nothing looks for hidden ground. The horizon may still be
  /// left out, because near here it hid next to nothing.
  std::optional<OcclusionMethod> occlusion;
  /// Sentences that say why occlusion was not used as the request asked, and what is used instead; else
  /// empty.
  std::string note;
};

/// Holds what drawing one image did; everything but `counters` belongs to this frame alone.
struct FrameResult : OcclusionResult {
  VisibleSet visible;
  FrameCost cost;  ///< milliseconds; `gpu` is NaN until the first timer query has returned
  std::size_t tilesInCut = 0;
  bool patches = false;  ///< the nodes of `visible` are patches
  PagingFrame paging;
  ObjectFrame objects;       ///< `visible` counts their triangles and vertices too
  StaticLodFrame staticLod;  ///< if `drawn`, the nodes of `visible` are nodes of the static trees
  FrameCounters counters;
};

}  // namespace trimtab
