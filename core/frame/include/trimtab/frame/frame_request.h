#pragma once

#include <algorithm>
#include <optional>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/frame_levers.h"
#include "trimtab/frame/hold_decision.h"
#include "trimtab/frame/overlays.h"
#include "trimtab/frame/symbology_request.h"
#include "trimtab/preset/parameters.h"

/// The request for one image.
namespace trimtab {

/// Work that a frame skips because its result is known. If false, the work is done all the same, which
/// changes no pixel and measures what the skip saves.
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

/// Holds everything that one image depends on.
struct FrameRequest {
  double time = 0;  ///< seconds on the host's clock; precipitation and blur follow it
  GeodeticPosition eye;
  std::optional<Velocity> velocity;  ///< of the eye; precipitation streaks along it
  Wind wind;                         ///< precipitation streaks against it too
  /// The way of the air in the wind since the session began, metres, in earth-centred axes; precipitation
  /// drifts with it.
  Vec3 airDrift;
  PrecipitationLook rain = kRainLook, snow = kSnowLook;
  PrecipitationForm precipitationForm = PrecipitationForm::bounded;
  /// What falls while it fades in or out; if unset, what the decision says. The published effect does not
  /// fade.
  std::optional<FadingPrecipitation> fading;
  Attitude attitude;  ///< of the view: aircraft, or aircraft and head
  ViewShape view;     ///< perspective, and the image's size
  /// Pixels of the image per radian, which errors in pixels count, if `view` is a scene of another size that
  /// is scaled to the image; 0: those of `view`.
  double imagePxPerRadian = 0;
  FrameDecision decision;
  /// The levers, step by step: LeverChain::drawn is all that the renderer reads of it, the other links say
  /// who changed what.
  LeverChain levers;
  HoldDecision hold;  ///< the reason of the chain's last step
  CullingCase cullingCase = CullingCase::proposed;
  OcclusionMethod occlusion =
      OcclusionMethod::depth_map;  ///< of levels and patches; static trees have their own
  bool backFaces = true;           ///< culls nodes that face away from the eye, except in CullingCase::none
  Metres spreadFrom{5000};         ///< as LodParameters::spreadFrom
  bool scaleTexture = false;       ///< the ground's texture shrinks with the LOD scale too
  double lightPx = 0;              ///< as ObjectParameters::lightSize
  StaticLodParameters staticLod;   ///< apart from its errorPx, for which FrameLevers::treeErrorPx counts
  TerrainParameters terrain;
  Overlays overlays;
  /// If set, culling and LOD selection use this eye while the image uses the real one; its frustum is drawn.
  std::optional<EyePose> frozenEye;
  /// Symbols over the image, never blurred; if unset, the pass is not run.
  std::optional<SymbologyRequest> symbology;
  /// Waits after each pass, so that FrameCost separates blur, weather and symbology on a software rasteriser
  /// too. It costs time, so use it for measurements.
  bool separateStages = false;
  /// Waits for the image, so that the total of FrameCost includes the GPU's work, and `gpu` and its parts
  /// belong to this frame. Use it for measurements. A software rasteriser is always waited for.
  bool waitForImage = false;
  /// Waits for the pages that this view needs, so that the image depends on the request alone. Use it for
  /// measurements and comparisons. If false, no frame waits, and what has not been read yet is drawn coarser.
  bool waitForPages = false;
  /// Makes OcclusionMethod::automatic use the horizon, so that counts depend on the requests alone and not on
  /// a clock. Without Skips::littleHidden, no horizon of another eye position is used either.
  bool reproducible = false;
  /// Makes readHorizon, and readDepthMap if a horizon is in use, report all that the horizon proves, not only
  /// what tests asked for. It costs a twentieth of the horizon.
  bool wholeHorizon = false;
  /// Rounds vertices to the rasteriser's grid before it interpolates, so that on a software rasteriser no
  /// sliver shows a wrong colour or depth: without it 3 of 692 images of 960 x 540 had such a pixel, over
  /// Hawaii, Iceland and Kansai. It changes one pixel in 235, nearly all by one grey level, so it is for
  /// measurements. A GPU needs no help, and nothing is done there.
  bool exactSlivers = false;
  Skips skips;
};

/// Returns the distance from the eye, metres, beyond which this frame draws no terrain: the far
/// distance of its levers. It is infinite if nothing sets one, or if Skips::beyondVisibility is off.
inline double farCutM(const FrameRequest& request) {
  return request.skips.beyondVisibility ? request.levers.drawn.farM : WeatherDecision::kUnlimited;
}

/// Returns what falls in this image: what the decision says, or in the bounded form what fades in or out.
FadingPrecipitation fallsNow(const FrameRequest& request);

/// Returns the pixels of an angle of one radian that errors in pixels count.
inline double errorPxPerRadian(const FrameRequest& request) {
  return request.imagePxPerRadian > 0 ? request.imagePxPerRadian : pixelsPerRadian(request.view);
}

/// The forms in which a terrain can be drawn.
struct FormsOfTerrain {
  bool tiles = false, patches = false, trees = false;
};
/// Returns the form in which a terrain is drawn: the one that the request asks for if the terrain has it,
/// else patches or tiles, whichever it has. It is unset if it has neither; static trees are drawn only on
/// request.
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const FormsOfTerrain& forms);

/// Reports whether the request asks for static trees, if the terrain has them.
inline bool asksForTrees(const FrameRequest& request) {
  return request.terrain.form == TerrainForm::static_trees || request.overlays.treeDepth >= 0 ||
         request.overlays.treePicture || request.overlays.textureSquares;
}

}  // namespace trimtab
