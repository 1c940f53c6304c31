#include "trimtab/scene/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/guard_band.h"
#include "core/scene/renderer_parts.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/units/sphere.h"

namespace trimtab::scene {
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database) {
  if (!database) return {};
  return formDrawn(request, FormsOfTerrain{database->index().size() > 0, database->patches() != nullptr,
                                           database->staticLod() != nullptr});
}

void Renderer::Impl::drawForm(const SceneView& view, SceneShaders tilesShaders, bool wire,
                              void (TerrainDrawer::*drawNodes)(unsigned program)) {
  const WideViewport wide(view.shape, view.guardBand);
  const int form = static_cast<int>(*view.form);
  (terrain->*drawNodes)(gl->programs.use(SceneShaders{static_cast<int>(tilesShaders) + form}, wire));
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
  terrain = view.form ? forms()[static_cast<std::size_t>(*view.form)] : foreign.active() ? &foreign : nullptr;
  lines.clear();
  if (terrain) {
    const FrameInProgress frame{r, view.eye, view.shape, view.guardBand, gl->clock, report.software};
    PreparedTerrain prepared = terrain->prepare(frame);
    if (!prepared.depth) objects.prepare(frame, prepared.hiddenCells);  // else once the map is drawn
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

namespace {

/// What passes read of the frame that is being drawn, and the counts that they add to.
struct DrawnFrame {
  Renderer::Impl& renderer;
  const FrameRequest& request;  ///< of the image, which may be larger than the scene
  const SceneView& view;
  FrameCounters& done;
};

/// Into what a pass draws: maps of its own, the scene, or the image, which is the scene scaled up.
enum class PassTarget { own, scene, image };

struct FramePass {
  const char* name;
  PassTarget target;  ///< it is bound before the pass
  CostField part;     ///< of the frame's cost, which gets its time; null if it belongs to no part
  bool (*runs)(const DrawnFrame&);
  void (*draw)(const DrawnFrame&);
};

bool falls(const DrawnFrame& f, PrecipitationForm form) {
  return f.view.precipitation && f.view.precipitation->form == form;
}
double blurOf(const DrawnFrame& f) {
  return f.request.levers.drawn.blurStrength;
}

/// A frame, pass by pass, in order.
constexpr FramePass kPasses[] = {
    // The published depth map: drawn, reduced to a pyramid, and read back for what it hides.
    {"occluders", PassTarget::own, nullptr, [](const DrawnFrame& f) { return f.view.depth.has_value(); },
     [](const DrawnFrame& f) {
       f.renderer.gl->programs.use(SceneShaders::occluders);
       f.renderer.tiles.drawOccluders();
     }},
    {"pyramid", PassTarget::own, nullptr, [](const DrawnFrame& f) { return f.view.depth.has_value(); },
     [](const DrawnFrame& f) {
       f.renderer.tiles.reduce(f.renderer.gl->programs.use(SceneShaders::depth_reduce));
     }},
    {"test", PassTarget::own, nullptr, [](const DrawnFrame& f) { return f.view.depth.has_value(); },
     [](const DrawnFrame& f) {
       f.renderer.gl->programs.use(SceneShaders::occlusion_test);
       const std::span<const std::uint8_t> hiddenCells = f.renderer.tiles.removeHidden();
       f.renderer.gl->clock.lap(&FrameCost::occlusion);
       f.renderer.objects.prepare(f.renderer.tiles.frame(), hiddenCells);
     }},
    {"clear", PassTarget::scene, nullptr, [](const DrawnFrame&) { return true; },
     [](const DrawnFrame& f) { f.renderer.gl->programs.clear(true); }},
    {"surface", PassTarget::scene, nullptr,
     [](const DrawnFrame& f) { return f.view.form && !f.view.treePicture; },
     [](const DrawnFrame& f) {
       f.renderer.drawForm(f.view, SceneShaders::tiles, false, &TerrainDrawer::draw);
     }},
    {"foreign scene", PassTarget::scene, nullptr,
     [](const DrawnFrame& f) { return f.renderer.terrain == &f.renderer.foreign; },
     [](const DrawnFrame& f) { f.renderer.foreign.drawScene(f.view.air); }},
    {"objects", PassTarget::scene, nullptr,
     [](const DrawnFrame& f) { return f.view.form && !f.view.treePicture && f.renderer.objects.drawsAny(); },
     [](const DrawnFrame& f) { f.renderer.objects.draw(f.renderer.gl->programs, false); }},
    {"tree picture", PassTarget::scene, nullptr, [](const DrawnFrame& f) { return f.view.treePicture; },
     [](const DrawnFrame& f) {
       f.renderer.trees.drawPicture(f.renderer.gl->programs.use(SceneShaders::tree_picture));
     }},
    {"wire", PassTarget::scene, nullptr,
     [](const DrawnFrame& f) { return f.view.form && !f.view.treePicture && f.view.wireframe; },
     [](const DrawnFrame& f) {
       f.renderer.drawForm(f.view, SceneShaders::tiles, true, &TerrainDrawer::drawWire);
       if (f.renderer.objects.drawsAny()) f.renderer.objects.draw(f.renderer.gl->programs, true);
     }},
    {"lines", PassTarget::scene, nullptr, [](const DrawnFrame& f) { return f.view.lines; },
     [](const DrawnFrame& f) {
       f.renderer.gl->programs.use(SceneShaders::lines);
       f.renderer.gl->lineBuffer.draw(f.renderer.lines);
     }},
    {"sky", PassTarget::scene, nullptr, [](const DrawnFrame& f) { return f.view.sky; },
     [](const DrawnFrame& f) {
       f.renderer.gl->programs.use(SceneShaders::sky);
       glDrawArrays(GL_TRIANGLES, 0, 3);
     }},
    {"published precipitation", PassTarget::scene, &FrameCost::weather,
     [](const DrawnFrame& f) { return falls(f, PrecipitationForm::effect); },
     [](const DrawnFrame& f) {
       auto& effect = f.renderer.gl->effect;
       if (!effect) effect.emplace();
       effect->draw(*f.view.precipitation, f.view, f.renderer.scene().id());
     }},
    {"bounded precipitation", PassTarget::scene, &FrameCost::weather,
     [](const DrawnFrame& f) { return falls(f, PrecipitationForm::bounded); },
     [](const DrawnFrame& f) {
       f.done.particlesDrawn += f.renderer.gl->precipitation.draw(*f.view.precipitation, f.view);
     }},
    // Before the scene is scaled up, so that blur and scene cost the same number of pixels.
    {"blur", PassTarget::scene, &FrameCost::blur,
     [](const DrawnFrame& f) { return blurOf(f) > 0 || !f.request.skips.blurAtRest; },
     [](const DrawnFrame& f) {
       if (!(blurOf(f) > 0)) f.renderer.gl->blur.rest();
       f.renderer.gl->blur.apply(f.renderer.scene(), blurOf(f), f.request.time);
       ++f.done.blurPasses;
     }},
    {"scale up", PassTarget::own, nullptr,
     [](const DrawnFrame& f) { return &f.renderer.scene() != &f.renderer.gl->frame; },
     [](const DrawnFrame& f) {
       f.renderer.gl->frame.resize(f.request.view.widthPx, f.request.view.heightPx);
       f.renderer.gl->scaleUp.draw(f.renderer.gl->small, f.renderer.gl->frame);
     }},
    // Last, at the image's size, so that symbols stay sharp.
    {"symbols", PassTarget::image, &FrameCost::symbology,
     [](const DrawnFrame& f) { return f.request.symbology && f.request.symbology->setup.general.enabled; },
     [](const DrawnFrame& f) {
       SymbologyPass& symbology = f.renderer.gl->symbology;
       const bool redrawn =
           symbology.draw(*f.request.symbology, f.request.view, !f.request.skips.sameSymbols);
       f.done.symbologyRedraws += redrawn;
       if (redrawn) f.done.hostSymbolsLeftOut += symbology.hostSymbolsLeftOut();
       ++f.done.symbologyDraws;
     }},
};

/// Returns the request for a scene of `size`, whose errors still count the image's pixels.
FrameRequest atSize(FrameRequest request, const ViewShape& size) {
  request.imagePxPerRadian = pixelsPerRadian(request.view);
  request.view = size;
  return request;
}

}  // namespace

FrameResult Renderer::Impl::draw(const FrameRequest& r, unsigned fbo) {
  gl->clock.start(report.software, r.separateStages, r.waitForImage);
  lastView = r.view;
  lastScene = scaledShape(r.view, r.levers.drawn.renderScale);
  std::optional<FrameRequest> smaller;
  if (lastScene != lastView) smaller = atSize(r, lastScene);
  const FrameRequest& drawn = smaller ? *smaller : r;
  SceneView view = viewOf(drawn);
  FrameResult result = prepare(drawn, view);

  (smaller ? gl->small : gl->frame).resize(lastScene.widthPx, lastScene.heightPx);
  gl->programs.begin(view);
  gl->clock.lap(&FrameCost::cull);
  const DrawnFrame frame{*this, r, view, result.counters};
  for (const FramePass& pass : kPasses) {
    if (!pass.runs(frame)) continue;
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, pass.name);  // for debuggers of GL
    if (pass.part) gl->clock.beginPart(pass.part);
    if (pass.target != PassTarget::own)
      glBindFramebuffer(GL_FRAMEBUFFER, pass.target == PassTarget::image ? gl->frame.id() : scene().id());
    pass.draw(frame);
    if (pass.part) gl->clock.endPart(pass.part);
    glPopDebugGroup();
  }
  if (!(blurOf(frame) > 0)) gl->blur.rest();

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
    result.objects = objects.frame();
    if (terrain == &trees) result.staticLod = trees.frame();
    result.visible.triangles += result.objects.triangles;
    result.visible.vertices += result.objects.vertices;
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

std::vector<std::uint32_t> Renderer::Impl::readNumbers(bool unculled, bool ofObjects) {
  if (!gl || !shown) return {};
  SceneView view = *shown;
  view.shape = lastView;
  view.guardBand = guardBandOf(lastView, gl->viewports);
  view.depth.reset();
  if (terrain) counters.tilesBuilt += terrain->prepareNumbers(unculled);
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  gl->nodes.begin(lastView.widthPx, lastView.heightPx);
  gl->programs.begin(view);
  gl->programs.clear(false);
  if (view.form) drawForm(view, SceneShaders::tile_numbers, false, &TerrainDrawer::drawNumbered);
  if (ofObjects) {
    gl->nodes.forget();
    if (terrain && objects.drawsAny()) objects.drawNumbers(gl->programs);
  }
  std::vector<std::uint32_t> numbers = gl->nodes.read();
  leaveContext(static_cast<GLuint>(before));
  return numbers;
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

GlReport Renderer::initialize() {
  release();
  impl_->report = reportContext();
  if (impl_->report.usable) {
    impl_->gl = std::make_unique<Impl::Gl>(impl_->report.software);
    for (TerrainDrawer* form : impl_->forms()) form->initialize();
    impl_->objects.initialize();
  }
  return impl_->report;
}

void Renderer::release() {
  impl_->shown.reset();
  impl_->lastView = impl_->lastScene = kNoImage;
  impl_->terrain = nullptr;
  for (TerrainDrawer* form : impl_->forms()) form->release();
  impl_->objects.release();
  impl_->gl.reset();
}

void Renderer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  impl_->shown.reset();
  impl_->terrain = nullptr;
  impl_->database = std::move(database);
  for (TerrainDrawer* form : impl_->forms()) form->setTerrain(impl_->database);
  impl_->objects.setTerrain(impl_->database);
}

FrameResult Renderer::draw(const FrameRequest& request, unsigned fbo) {
  const ViewShape& v = request.view;
  if (!impl_->gl || v.widthPx <= 0 || v.heightPx <= 0) return {};
  const double across = v.right - v.left, upward = v.top - v.bottom;
  if (across > 0 && upward > 0 && std::isfinite(across + upward)) return impl_->draw(request, fbo);
  // A view that is none, turned round for one, shows whatever GL makes of it: nothing is left out.
  FrameRequest whole = request;
  whole.cullingCase = CullingCase::none;
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
  return elevationsOf(*horizon, samples);
}

Findings Renderer::pageFailures() const {
  return impl_->foreign.active() ? impl_->foreign.failures() : impl_->patches.failures();
}

void plant(Renderer& renderer, const Defects& defects) {
  for (TerrainDrawer* form : renderer.impl_->forms()) form->plant(defects);
}

std::vector<std::uint32_t> Renderer::readNodes(bool unculled) {
  return impl_->readNumbers(unculled, false);
}

std::vector<std::uint32_t> Renderer::readObjects() {
  return impl_->readNumbers(false, true);
}

std::vector<std::uint8_t> Renderer::readPixels(int width, int height) {
  if (impl_->gl) return impl_->gl->frame.readPixels(width, height);
  return std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
}

void Renderer::forgetPictures() {
  if (impl_->gl) impl_->gl->blur.rest();
}

}  // namespace trimtab::scene
