#pragma once

#include <optional>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/overlays.h"
#include "trimtab/frame/symbology_request.h"
#include "trimtab/preset/parameters.h"

/// What a renderer is asked to draw: everything that one image depends on.
namespace trimtab {

/// Work that a frame leaves out because its result is known. False does it all the same, which changes no
/// pixel: for measurements of what leaving it out saves.
struct Skips {
  bool sameCut = true;           ///< levels are chosen again only when what they depend on has changed
  bool beyondVisibility = true;  ///< what is farther than the weather's cut is not drawn
  bool sameHorizon = true;       ///< built again only when the eye's place or the levels have changed
  bool littleHidden = true;      ///< no occlusion work near where it hid next to nothing
  bool schemeFrustum = true;     ///< no occlusion work where the decision has no depth map's size
  bool sameVisible = true;       ///< the visible set is chosen again only when something in it can change
  bool tilesOnGpu = true;        ///< what was made and uploaded once is not made again
  bool blurAtRest = true;        ///< no blur pass where its strength is 0
  bool clearAir = true;          ///< no precipitation pass where nothing falls
  bool sameSymbols = true;       ///< symbols are made again only when something in them has changed
  friend bool operator==(const Skips&, const Skips&) = default;
};

/// Everything one picture depends on.
struct FrameRequest {
  double time = 0;  ///< seconds, the host's clock: what moves by itself is where it is at this time
  GeodeticPosition eye;
  std::optional<Velocity> velocity;  ///< of the eye: what falls streaks along it
  Attitude attitude;                 ///< of the view: aircraft, or aircraft and head
  ViewShape view;                    ///< size of the picture
  FrameDecision decision;
  CullingCase method = CullingCase::proposed;
  OcclusionMethod occlusion =
      OcclusionMethod::depth_map;  ///< of levels and patches; static trees have their own
  bool backFaces = true;  ///< what the eye can only see from behind is left out, but in CullingCase::none
  LodParameters lod;
  StaticLodParameters staticLod;
  TerrainParameters terrain;
  Overlays overlays;
  /// Culling and levels stand still as of this view while the eye moves on; its frustum is drawn.
  std::optional<EyePose> frozenEye;
  /// Over all of it, and never blurred; nothing of it is run where it is absent.
  std::optional<SymbologyRequest> symbology;
  /// Waits after each pass, so that FrameCost tells blur, weather and symbology apart on a software
  /// rasteriser too. Costs time: for measurements.
  bool separateStages = false;
  /// The total of FrameCost holds the GPU's work too, and `gpu` and the parts are of this very frame: waits
  /// for the picture. For measurements; a software rasteriser is always waited for.
  bool waitForPicture = false;
  /// What this view asks of the disk is waited for, so that the picture depends on the request alone. For
  /// measurements and comparisons; else no frame waits, and what is not there yet is drawn coarser.
  bool waitForPages = false;
  /// What is counted depends on the requests alone, and on no clock: OcclusionMethod::automatic is the
  /// horizon.
  bool reproducible = false;
  /// readHorizon, and readDepthMap where a horizon serves, tell all that it proves, not only as much as a
  /// tile's test asked for. Costs a twentieth of the horizon.
  bool wholeHorizon = false;
  Skips skips;
};

/// Returns the distance from the eye, metres, beyond which this frame draws no terrain: the weather's far
/// cut. Infinite if the weather sets none, or if Skips::beyondVisibility is off.
inline double farCutM(const FrameRequest& request) {
  return request.skips.beyondVisibility ? request.decision.weather.farM : WeatherDecision::kUnlimited;
}

/// Whether a terrain that has static trees is drawn from them.
inline bool asksForTrees(const FrameRequest& request) {
  return request.staticLod.terrain == TerrainForm::static_trees || request.overlays.treeDepth >= 0 ||
         request.overlays.treePicture;
}

}  // namespace trimtab
