#include "trimtab/scene/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/guard_band.h"
#include "core/scene/gl/stage_clock.h"
#include "core/scene/passes/blur_pass.h"
#include "core/scene/passes/lines.h"
#include "core/scene/passes/node_pass.h"
#include "core/scene/passes/precipitation_pass.h"
#include "core/scene/passes/scale_up_pass.h"
#include "core/scene/passes/symbology_pass.h"
#include "core/scene/passes/weather_precipitation.h"
#include "core/scene/terrain/patches/patch_drawer.h"
#include "core/scene/terrain/static_trees/tree_drawer.h"
#include "core/scene/terrain/tiles/tile_drawer.h"
#include "scene_graph.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/units/sphere.h"

namespace trimtab::scene {
namespace {

constexpr ViewShape kNoImage{.widthPx = 0, .heightPx = 0};

}  // namespace

std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database) {
  if (!database) return {};
  return formDrawn(request, FormsOfTerrain{database->index().size() > 0, database->patches() != nullptr,
                                           database->staticLod() != nullptr});
}

struct Renderer::Impl {
  GlReport report;
  std::shared_ptr<const terrain::Database> database;
  TileDrawer tiles;
  PatchDrawer patches;
  TreeDrawer trees;
  TerrainDrawer* terrain = nullptr;  ///< that drew the last image; null: no terrain
  FrameCounters counters;            ///< since this renderer was made

  /// The last image's, and the size at which its scene was drawn; without pixels before the first image.
  ViewShape lastView = kNoImage, lastScene = kNoImage;
  std::optional<SceneView> shown;  ///< the last image's
  std::vector<LineVertex> lines;

  /// Holds what lives in the context, but for the terrain.
  struct Gl {
    Gl(ScenePasses passes, bool software) : blur(software), scaleUp(software), graph(std::move(passes)) {}
    FrameBuffer frame;
    FrameBuffer small;  ///< the scene before it is scaled up, if the request asks for that
    NodeTarget nodes;
    LineBuffer lineBuffer;
    PrecipitationPass precipitation;
    BlurPass blur;
    ScaleUpPass scaleUp;
    SymbologyPass symbology;
    StageClock clock;
    SceneGraph graph;
    const ViewportLimits viewports = viewportLimitsOfContext();
  };
  std::unique_ptr<Gl> gl;

  ScenePasses passes() {
    return {.begin = [this](unsigned) { gl->clock.lap(&FrameCost::cull); },
            .occluders = [this](unsigned) { tiles.drawOccluders(); },
            .reduce = [this](unsigned program) { tiles.reduce(program); },
            .test = [this](unsigned) { removeHidden(); },
            .surface = [this](unsigned program) { terrain->draw(program); },
            .wire = [this](unsigned program) { terrain->drawWire(program); },
            .numbers = [this](unsigned program) { terrain->drawNumbered(program); },
            .treePicture = [this](unsigned program) { trees.drawPicture(program); },
            .lines = [this](unsigned) { gl->lineBuffer.draw(lines); },
            .beforeWeather = [this](unsigned) { gl->clock.beginPart(&FrameCost::weather); },
            .afterWeather = [this](unsigned) { gl->clock.endPart(&FrameCost::weather); }};
  }

  std::array<TerrainDrawer*, 3> forms() { return {&tiles, &patches, &trees}; }
  TerrainDrawer* drawerOf(TerrainForm form);
  void removeHidden();
  SceneView viewOf(const FrameRequest& r) const;
  FrameResult prepare(const FrameRequest& r, SceneView& view);
  const FrameBuffer& scene() const { return lastScene == lastView ? gl->frame : gl->small; }
  FrameCounters drawPrecipitation(const SceneView& view);
  FrameCounters blurScene(const FrameRequest& r);
  void scaleUp();
  FrameCounters drawSymbols(const FrameRequest& r);
  FrameResult draw(const FrameRequest& r, unsigned fbo);
  static void leaveContext(unsigned fbo);
  std::vector<std::uint32_t> readNodes(bool unculled);
};

TerrainDrawer* Renderer::Impl::drawerOf(TerrainForm form) {
  return forms()[static_cast<std::size_t>(form)];
}

void Renderer::Impl::removeHidden() {
  tiles.removeHidden();
  glBindFramebuffer(GL_FRAMEBUFFER, scene().id());
  gl->clock.lap(&FrameCost::occlusion);
}

/// Returns the part of a frame's view that follows from the request alone.
SceneView Renderer::Impl::viewOf(const FrameRequest& r) const {
  SceneView view;
  view.shape = r.view;
  view.guardBand = guardBandOf(r.view, gl->viewports);
  view.sky = !r.overlays.showHoles;
  view.wireframe = r.overlays.wireframe;
  view.textureSquares = r.overlays.textureSquares;
  view.tinted = r.overlays.colourByReason || r.overlays.colourByLevel;
  // Culled nodes are shown by their colour, however far away they are.
  if (!r.overlays.colourByReason) view.air = airOf(r.decision.weather, r.levers.drawn.farM);
  view.heightM = r.eye.height.value();
  if (r.exactSlivers && report.software) view.gridStepsPerPixel = 1 << subpixelBitsOfContext();
  view.form = formDrawn(r, database.get());
  view.groundTexture = database && database->ground();
  const LocalFrame local = database ? database->index().frame : LocalFrame(r.eye);
  view.eye.axes = eyeAxes(local, r.eye, r.attitude);
  if (database) {
    view.eye.position = local.fromGeodetic(r.eye);
    view.up = local.ecefToLocal() * eastNorthUp(r.eye.latitude, r.eye.longitude).row[2];
  }
  view.precipitation = precipitationView(r, local);
  // An effect without drops: for measuring what skips.clearAir saves.
  if (!view.precipitation && !r.skips.clearAir) view.precipitation.emplace().form = r.precipitationForm;
  view.horizonDip = horizonDip(r.eye.height.value());
  return view;
}

/// Lets the terrain prepare what it draws, and merges what it found into the view and the frame's result.
FrameResult Renderer::Impl::prepare(const FrameRequest& r, SceneView& view) {
  FrameResult result;
  terrain = view.form ? drawerOf(*view.form) : nullptr;
  lines.clear();
  if (terrain) {
    PreparedTerrain prepared =
        terrain->prepare({r, view.eye, view.shape, view.guardBand, gl->clock, report.software});
    static_cast<OcclusionResult&>(result) = std::move(prepared.occlusion);
    result.paging = prepared.paging;
    result.patches = terrain == &patches;
    result.counters = prepared.counters;
    view.depth = prepared.depth;
    view.oneSided = prepared.oneSided;
    view.treePicture = prepared.treePicture;
    lines = std::move(prepared.lines);
  }
  if (r.frozenEye) addFrustum(*r.frozenEye, r.view, view.eye.position, lines);
  view.lines = !lines.empty();
  result.counters.precipitationPasses = view.precipitation.has_value();
  return result;
}

/// Draws rain and snow of the bounded form; the published effect is a part of the scene.
FrameCounters Renderer::Impl::drawPrecipitation(const SceneView& view) {
  FrameCounters done;
  if (!view.precipitation || view.precipitation->form != PrecipitationForm::bounded) return done;
  gl->clock.beginPart(&FrameCost::weather);
  done.particlesDrawn += gl->precipitation.draw(*view.precipitation, view);
  gl->clock.endPart(&FrameCost::weather);
  return done;
}

/// Blurs the scene, before it is scaled up, so that blur and scene cost the same number of pixels.
FrameCounters Renderer::Impl::blurScene(const FrameRequest& r) {
  FrameCounters done;
  const double strength = r.levers.drawn.blurStrength;
  if (strength > 0 || !r.skips.blurAtRest) {
    gl->clock.beginPart(&FrameCost::blur);
    if (!(strength > 0)) gl->blur.rest();
    gl->blur.apply(scene(), strength, r.time);
    gl->clock.endPart(&FrameCost::blur);
    ++done.blurPasses;
  }
  if (!(strength > 0)) gl->blur.rest();
  return done;
}

/// Fills the image with the scene. Between pixels its colours are interpolated.
void Renderer::Impl::scaleUp() {
  if (&scene() == &gl->frame) return;
  gl->frame.resize(lastView.widthPx, lastView.heightPx);
  gl->scaleUp.draw(gl->small, gl->frame);
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
}

/// The symbols are drawn last, at the image's size, so that they stay sharp.
FrameCounters Renderer::Impl::drawSymbols(const FrameRequest& r) {
  FrameCounters done;
  if (!r.symbology || !r.symbology->setup.general.enabled) return done;
  gl->clock.beginPart(&FrameCost::symbology);
  const bool redrawn = gl->symbology.draw(*r.symbology, r.view, !r.skips.sameSymbols);
  done.symbologyRedraws += redrawn;
  if (redrawn) done.hostSymbolsLeftOut += gl->symbology.hostSymbolsLeftOut();
  gl->clock.endPart(&FrameCost::symbology);
  ++done.symbologyDraws;
  return done;
}

/// Returns the request for a scene of `size`, whose errors still count the image's pixels.
FrameRequest atSize(FrameRequest request, const ViewShape& size) {
  request.imagePxPerRadian = pixelsPerRadian(request.view);
  request.view = size;
  return request;
}

FrameResult Renderer::Impl::draw(const FrameRequest& r, unsigned fbo) {
  gl->clock.start(report.software, r.separateStages, r.waitForPicture);
  lastView = r.view;
  lastScene = scaledShape(r.view, r.levers.drawn.renderScale);
  std::optional<FrameRequest> smaller;
  if (lastScene != lastView) smaller = atSize(r, lastScene);
  const FrameRequest& drawn = smaller ? *smaller : r;
  SceneView view = viewOf(drawn);
  FrameResult result = prepare(drawn, view);

  FrameBuffer& target = smaller ? gl->small : gl->frame;
  target.resize(lastScene.widthPx, lastScene.heightPx);
  glBindFramebuffer(GL_FRAMEBUFFER, target.id());
  gl->graph.frame(view, target.id());
  glBindFramebuffer(GL_FRAMEBUFFER, target.id());
  result.counters += drawPrecipitation(view);
  result.counters += blurScene(r);
  scaleUp();
  result.counters += drawSymbols(r);

  glBindFramebuffer(GL_READ_FRAMEBUFFER, gl->frame.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, fbo);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, r.view.widthPx, r.view.heightPx, 0, 0, r.view.widthPx, r.view.heightPx,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  leaveContext(fbo);
  shown = std::move(view);
  result.cost = gl->clock.finish();
  if (terrain) {
    result.visible = terrain->visible();
    result.tilesInCut = terrain->cut().size();
    if (terrain == &trees) result.staticLod = trees.frame();
    terrain->finished(result);
  }
  counters += result.counters;
  result.counters = counters;
  return result;
}

/// Leaves the context as others who share it assume it to be.
void Renderer::Impl::leaveContext(unsigned fbo) {
  glBindFramebuffer(GL_FRAMEBUFFER, fbo);
  glUseProgram(0);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND}) glDisable(off);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glClearDepth(1);
}

std::vector<std::uint32_t> Renderer::Impl::readNodes(bool unculled) {
  SceneView view = *shown;
  view.nodes = true;
  view.shape = lastView;
  view.guardBand = guardBandOf(lastView, gl->viewports);
  view.depth.reset();
  view.precipitation.reset();
  view.sky = view.wireframe = view.lines = view.treePicture = false;
  if (terrain) counters.tilesBuilt += terrain->prepareNumbers(unculled);
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  gl->nodes.begin(lastView.widthPx, lastView.heightPx);
  gl->graph.frame(view, gl->nodes.id());
  std::vector<std::uint32_t> nodes = gl->nodes.read();
  leaveContext(static_cast<GLuint>(before));
  return nodes;
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

GlReport Renderer::initialize() {
  release();
  impl_->report = reportContext();
  if (impl_->report.usable) {
    impl_->gl = std::make_unique<Impl::Gl>(impl_->passes(), impl_->report.software);
    for (TerrainDrawer* form : impl_->forms()) form->initialize();
  }
  return impl_->report;
}

void Renderer::release() {
  impl_->shown.reset();
  impl_->lastView = impl_->lastScene = kNoImage;
  impl_->terrain = nullptr;
  for (TerrainDrawer* form : impl_->forms()) form->release();
  impl_->gl.reset();
}

void Renderer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  impl_->shown.reset();
  impl_->terrain = nullptr;
  impl_->database = std::move(database);
  for (TerrainDrawer* form : impl_->forms()) form->setTerrain(impl_->database);
}

FrameResult Renderer::draw(const FrameRequest& request, unsigned fbo) {
  const ViewShape& v = request.view;
  if (!impl_->gl || v.widthPx <= 0 || v.heightPx <= 0) return {};
  const double across = v.right - v.left, upward = v.top - v.bottom;
  if (across > 0 && upward > 0 && std::isfinite(across + upward)) return impl_->draw(request, fbo);
  // A view that is none, turned round for one, shows whatever GL makes of it: nothing is left out.
  FrameRequest whole = request;
  whole.method = CullingCase::none;
  return impl_->draw(whole, fbo);
}

BuiltAhead Renderer::buildAhead(std::span<const std::uint32_t> nodes, double withinMs) {
  if (!impl_->gl || !impl_->terrain) return {};
  if (!(withinMs > 0)) withinMs = 0;
  const auto whole = std::chrono::duration<double, std::milli>(std::min(withinMs, 1e6));
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::duration_cast<std::chrono::steady_clock::duration>(whole);
  const BuiltAhead ahead = impl_->terrain->buildAhead(nodes, deadline);
  impl_->counters.tilesBuiltAhead += ahead.built;
  return ahead;
}

std::vector<float> Renderer::readDistances() {
  if (!impl_->gl) return {};
  return impl_->scene().readDistances(impl_->lastScene, impl_->lastView);
}

DistanceImage Renderer::readDepthMap() {
  if (!impl_->gl || !impl_->terrain) return {};
  return impl_->terrain->readDepthMap();
}

std::vector<float> Renderer::readHorizon(int samples) {
  const Horizon* horizon = impl_->gl && impl_->terrain ? impl_->terrain->horizon() : nullptr;
  if (!horizon || samples <= 0) return {};
  std::vector<float> elevations;
  constexpr double kDegrees = 180 / std::numbers::pi;
  for (int i = 0; i < samples; ++i) {
    // Clockwise from south.
    const double turned = 2 * std::numbers::pi * (i + 0.5) / samples;
    const auto elevation = horizon->elevation(-std::sin(turned), -std::cos(turned));
    elevations.push_back(elevation ? static_cast<float>(*elevation * kDegrees)
                                   : std::numeric_limits<float>::quiet_NaN());
  }
  return elevations;
}

Findings Renderer::pageFailures() const {
  return impl_->patches.failures();
}

void plant(Renderer& renderer, const Defects& defects) {
  for (TerrainDrawer* form : renderer.impl_->forms()) form->plant(defects);
}

std::vector<std::uint32_t> Renderer::readNodes(bool unculled) {
  if (!impl_->gl || !impl_->shown) return {};
  return impl_->readNodes(unculled);
}

std::vector<std::uint8_t> Renderer::readPixels(int width, int height) {
  if (impl_->gl) return impl_->gl->frame.readPixels(width, height);
  return std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
}

void Renderer::forgetPictures() {
  if (impl_->gl) impl_->gl->blur.rest();
}

}  // namespace trimtab::scene
