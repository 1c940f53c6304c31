#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/static_lod_frame.h"
#include "trimtab/frame/terrain_frame.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/scene/symbology_geometry.h"
#include "trimtab/terrain/database.h"

/// Draws a frame. The same class behind the workbench's widget, the IG's window and the surfaceless context.
namespace trimtab::scene {

/// What of the picture is for the engineer, not for the pilot.
struct Overlays {
  bool wireframe = false, tileBounds = false, colourByLevel = false;
  bool colourByReason =
      false;  ///< draws what was culled too, so that it can be seen (with `frozenEye` above all)
  /// One level of the static trees whatever the distance, 0 at the roots; -1: by distance.
  int treeDepth = -1;
  bool treePicture = false;  ///< document E's: faces light grey, edges red, locked edges black
  bool voids = false;        ///< what was filled stands out, where patches are drawn
  bool showHoles = false;    ///< no sky: magenta wherever no terrain is drawn
  friend bool operator==(const Overlays&, const Overlays&) = default;
};

/// The colours of the overlays, sRGB, told apart by the colour-blind too (Okabe and Ito's set).
std::array<std::uint8_t, 3> reasonColour(CullReason reason);
std::array<std::uint8_t, 3> levelColour(int level);

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

/// Whether a terrain that has static trees is drawn from them.
inline bool asksForTrees(const FrameRequest& request) {
  return request.staticLod.terrain == TerrainForm::static_trees || request.overlays.treeDepth >= 0 ||
         request.overlays.treePicture;
}
/// In which form a terrain is drawn: that which is asked for where it has it, else what there is. None where
/// there is nothing.
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database);

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
  std::uint64_t mapsDrawnByCpu = 0, mapsReadBack = 0;
  std::uint64_t mapsLeftOut = 0;        ///< of the processor, as horizons are
  std::uint64_t occlusionsLeftOut = 0;  ///< because no method was worth its cost
  std::uint64_t visibleSelected = 0;    ///< visible sets that were chosen anew
};

/// GL text of the current context, and whether what the renderer needs is there.
struct GlReport {
  std::string vendor, renderer, version;
  bool software = false;
  bool usable = false;
  std::string missing;  ///< what is not there
  std::string drawing;  ///< how the terrain's draws reach GL, and why so (DrawChoice in multi_draw.h)
};

/// Mistakes made on purpose, so that a measurement can be seen to find them.
struct Defects {
  double loweringScale = 1;  ///< of what the proof of occlusion.h asks for; less than 1 loses pixels
  std::optional<std::uint32_t> culledNode = {};  ///< left out although it is visible
  double statedErrorScale = 1;  ///< of the errors that levels state; less than 1 understates them
  int depthMapShiftTexels = 0;  ///< the depth map is read so many texels to the side
  friend bool operator==(const Defects&, const Defects&) = default;
};

class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// All calls below need the context current that `initialize` was called with. No-throw; the report says
  /// what is missing.
  GlReport initialize();
  /// The context is going away: frees GL objects. `initialize` may be called again.
  void release();

  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// Draws into framebuffer `fbo` (0: the window's), whose size is at least the view's; leaves that
  /// framebuffer bound.
  FrameResult draw(const FrameRequest& request, unsigned fbo);

  /// Metres from the eye to what the last picture shows, infinity where nothing was drawn; row 0 at the
  /// bottom.
  std::vector<float> readDistances();

  /// The last depth map as 0..1 greys by distance (0 near), row 0 at the bottom; empty when the last frame
  /// had none.
  struct Grey {
    static constexpr double kNearestM = 50, kFurthestM = 200e3;  ///< black and nearly white, by the logarithm
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
  };
  Grey readDepthMap();
  /// The horizon that served in the last picture: elevation in degrees, evenly round from south by west,
  /// north and east of the terrain's frame; NaN where nothing bounds the sky. Empty where none served.
  std::vector<float> readHorizon(int samples);
  /// Pages of the terrain and tiles of its ground that could not be read (PagingFrame::failed counts them);
  /// it stays coarser there.
  Findings pageFailures() const;
  /// A blur accumulates from the next picture on, as if it were the first.
  void forgetPictures();
  /// For tests only, which must be able to see the picture break.
  void plant(const Defects& defects);
  /// For each pixel of the last picture the node that it shows, kNoNode where it is sky; row 0 at the bottom.
  /// Draws what was drawn once more: the same vertices in the same order with the same depth test. What only
  /// an overlay draws (lines, edges) is nobody's. Empty where nothing was drawn yet.
  ///
  /// `unculled`: which node it would show if nothing of the same levels had been left out, as in the picture
  /// of CullingCase::none (but for what is far outside the view: nearView in node_pass.h); what the weather's
  /// far cut takes away is still sky.
  static constexpr std::uint32_t kNoNode = 0xffffffffu;
  std::vector<std::uint32_t> readNodes(bool unculled = false);
  /// RGBA of what `draw` left, row 0 at the bottom.
  std::vector<std::uint8_t> readPixels(int width, int height);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
