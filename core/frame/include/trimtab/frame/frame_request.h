#pragma once

#include <algorithm>
#include <optional>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/overlays.h"
#include "trimtab/frame/symbology_request.h"
#include "trimtab/preset/parameters.h"

/// What a renderer is asked to draw: everything that one image depends on.
namespace trimtab {

/// Work that a frame skips because its result is known. False does the work all the same, which changes no
/// pixel: for measuring what the skip saves.
struct Skips {
  bool sameCut = true;           ///< selects a cut only if something that it depends on has changed
  bool beyondVisibility = true;  ///< does not draw nodes beyond the weather's far cut
  bool sameHorizon = true;       ///< builds a horizon only if the eye's position or the cut has changed
  bool littleHidden = true;      ///< skips occlusion near a place where it hid next to nothing
  bool schemeFrustum = true;     ///< skips occlusion if the decision has no depth map size
  bool sameVisible = true;       ///< selects the visible set only if it can have changed
  bool tilesOnGpu = true;        ///< does not build or upload a mesh twice
  bool blurAtRest = true;        ///< runs no blur pass at strength 0
  bool clearAir = true;          ///< runs no precipitation pass if nothing falls
  bool sameSymbols = true;       ///< builds the symbols' triangles only if something in them has changed
  friend bool operator==(const Skips&, const Skips&) = default;
};

/// Everything that one image depends on.
struct FrameRequest {
  double time = 0;  ///< seconds on the host's clock; precipitation and blur follow it
  GeodeticPosition eye;
  std::optional<Velocity> velocity;  ///< of the eye; precipitation streaks along it
  Attitude attitude;                 ///< of the view: aircraft, or aircraft and head
  ViewShape view;                    ///< perspective, and the image's size
  FrameDecision decision;
  CullingCase method = CullingCase::proposed;
  OcclusionMethod occlusion =
      OcclusionMethod::depth_map;  ///< of levels and patches; static trees have their own
  bool backFaces = true;           ///< culls nodes that face away from the eye, except in CullingCase::none
  LodParameters lod;
  StaticLodParameters staticLod;
  TerrainParameters terrain;
  Overlays overlays;
  /// If set, culling and LOD selection use this eye while the image uses the real one; its frustum is drawn.
  std::optional<EyePose> frozenEye;
  /// Symbols over the image, never blurred; if unset, the pass is not run.
  std::optional<SymbologyRequest> symbology;
  /// Waits after each pass, so that FrameCost separates blur, weather and symbology on a software rasteriser
  /// too. It costs time: for measurements.
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
  /// Rounds vertices to the rasteriser's grid before it interpolates, so that on a software rasteriser no
  /// sliver shows a wrong colour or depth: without it 3 of 692 images of 960 x 540 had such a pixel, over
  /// Hawaii, Iceland and Kansai. It changes one pixel in 235, nearly all by one grey level, so it is for
  /// measurements. A GPU needs no help, and nothing is done there.
  bool exactSlivers = false;
  Skips skips;
};

/// Returns the distance from the eye, metres, beyond which this frame draws no terrain: the weather's far
/// cut. Infinite if the weather sets none, or if Skips::beyondVisibility is off.
inline double farCutM(const FrameRequest& request) {
  return request.skips.beyondVisibility ? request.decision.weather.farM : WeatherDecision::kUnlimited;
}

/// Returns whether the request wants static trees, if the terrain has them.
inline bool asksForTrees(const FrameRequest& request) {
  return request.staticLod.terrain == TerrainForm::static_trees || request.overlays.treeDepth >= 0 ||
         request.overlays.treePicture;
}

}  // namespace trimtab
