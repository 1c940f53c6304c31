#include "trimtab/scene/renderer.h"

#include <algorithm>
#include <cmath>

#include "trimtab/scene/blur_pass.h"
#include "trimtab/scene/frame_buffer.h"
#include "trimtab/scene/frame_culling.h"
#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/lines.h"
#include "trimtab/scene/node_pass.h"
#include "trimtab/scene/occlusion.h"
#include "trimtab/scene/scene_graph.h"
#include "trimtab/scene/shaders.h"
#include "trimtab/scene/stage_clock.h"
#include "trimtab/scene/static_lod_culling.h"
#include "trimtab/scene/static_lod_layer.h"
#include "trimtab/scene/static_lod_occlusion.h"
#include "trimtab/scene/symbology_pass.h"
#include "trimtab/scene/tile_cache.h"
#include "trimtab/scene/weather_precipitation.h"

namespace trimtab::scene {
namespace {

std::uint32_t rgba(std::array<std::uint8_t, 3> c, std::uint8_t alpha) {
  return c[0] | static_cast<std::uint32_t>(c[1]) << 8 | static_cast<std::uint32_t>(c[2]) << 16 |
         static_cast<std::uint32_t>(alpha) << 24;
}

}  // namespace

struct Renderer::Impl {
  GlReport report;
  std::shared_ptr<const terrain::Database> database;
  FrameCulling culling;
  StaticLodCulling trees;
  FrameResult counters;

  // The frame in progress.
  const FrameRequest* request = nullptr;
  ViewShape lastView;
  std::optional<SceneView> shown;  ///< the last picture's
  std::vector<TileDraw> drawn;
  const std::vector<TileDraw>* numbered = nullptr;  ///< what the node pass draws
  std::vector<std::uint32_t> tints;
  std::vector<LineVertex> lines;

  /// Everything that lives in the context.
  struct Gl {
    explicit Gl(ScenePasses passes) : graph(std::move(passes)) {}
    FrameBuffer frame;
    NodeTarget nodes;
    TileCache tiles;
    StaticLodLayer trees;
    StaticLodOcclusion treeOcclusion;
    OcclusionPass occlusion;
    LineBuffer lineBuffer;
    BlurPass blur;
    SymbologyPass symbology;
    StageClock clock;
    SceneGraph graph;
  };
  std::unique_ptr<Gl> gl;

  ScenePasses passes() {
    return {
        .begin = [this](unsigned) { gl->clock.lap(&FrameCost::cull); },
        .occluders = [this](unsigned) { drawOccluders(); },
        .reduce = [this](unsigned program) { gl->occlusion.reduce(program); },
        .test = [this](unsigned) { removeHidden(); },
        .terrain = [this](unsigned) { drawTerrain(); },
        .wire = [this](unsigned) { drawWire(); },
        .trees = [this](unsigned program) { drawTrees(program); },
        .treeWire = [this](unsigned program) { drawTreeWire(program); },
        .treePicture = [this](unsigned program) { gl->trees.drawPicture(program, trees.visible().tiles); },
        .nodes = [this](unsigned) { drawTiles(*numbered); },
        .treeNodes = [this](unsigned program) { gl->trees.drawNumbered(program, *numbered); },
        .lines = [this](unsigned) { gl->lineBuffer.draw(lines); },
        .beforeWeather = [this](unsigned) { gl->clock.beginPart(&FrameCost::weather); },
        .afterWeather = [this](unsigned) { gl->clock.endPart(&FrameCost::weather); }};
  }

  void drawOccluders();
  void removeHidden();
  void drawTerrain();
  void drawTiles(const std::vector<TileDraw>& tiles);
  void drawWire();
  void drawTrees(unsigned program);
  void drawNodes(unsigned program, std::span<const TileDraw> nodes);
  void drawTreeWire(unsigned program);
  void prepareTrees(SceneView& view);
  void bindTileTextures(bool on);
  void prepare(SceneView& view);
  void paged(std::size_t built);
  void finishPicture();
  FrameResult draw(const FrameRequest& r, unsigned fbo);
  static void leaveContext(unsigned fbo);
  std::vector<std::uint32_t> readNodes(bool unculled);
};

void Renderer::Impl::drawOccluders() {
  gl->occlusion.beginDepth();
  bindTileTextures(true);
  gl->tiles.drawOccluders(culling.occluders());
  bindTileTextures(false);
}

void Renderer::Impl::removeHidden() {
  culling.removeHidden(gl->tiles, gl->occlusion);
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
  gl->clock.lap(&FrameCost::occlusion);
}

void Renderer::Impl::bindTileTextures(bool on) {
  glActiveTexture(GL_TEXTURE0 + kSlotUnit);
  glBindTexture(GL_TEXTURE_BUFFER, on ? gl->tiles.slotTexture() : 0);
  glActiveTexture(GL_TEXTURE0 + kTintUnit);
  glBindTexture(GL_TEXTURE_BUFFER, on ? gl->tiles.tintTexture() : 0);
  glActiveTexture(GL_TEXTURE0);
}

void Renderer::Impl::drawTerrain() {
  const Overlays& overlays = request->overlays;
  const VisibleSet& visible = culling.visible();
  drawn = overlays.colourByReason ? culling.cut().tiles : visible.tiles;
  if (overlays.colourByReason || overlays.colourByLevel) {
    tints.clear();
    for (const TileDraw& tile : drawn)
      tints.push_back(overlays.colourByReason ? rgba(reasonColour(visible.reason[tile.node]), 150)
                                              : rgba(levelColour(database->index().level[tile.node]), 150));
    gl->tiles.setTints(drawn, tints);
  }
  drawTiles(drawn);
}

void Renderer::Impl::drawTiles(const std::vector<TileDraw>& tiles) {
  bindTileTextures(true);
  gl->tiles.draw(tiles);
  bindTileTextures(false);
}

void Renderer::Impl::drawWire() {
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  drawTiles(drawn);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

/// The near nodes, then what they leave of the far ones.
void Renderer::Impl::drawTrees(unsigned program) {
  const bool byReason = request->overlays.colourByReason;
  const std::vector<TileDraw>& visible = trees.visible().tiles;
  const std::size_t near = trees.visibleNear();
  if (counters.depthMap) {
    drawNodes(program, std::span(visible).first(near));
    // Reading waits for the near nodes: a software rasteriser's time for them is not the map's.
    if (report.software) glFinish();
    gl->clock.lap(&FrameCost::draw);
    const ViewShape& v = request->view;
    gl->treeOcclusion.read(v.widthPx, v.heightPx, counters.depthMap->widthPx, counters.depthMap->heightPx);
    trees.removeHidden(gl->treeOcclusion.pyramid());
    gl->clock.lap(&FrameCost::occlusion);
    if (!byReason) drawNodes(program, std::span(visible).subspan(near));
  } else if (!byReason) {
    drawNodes(program, visible);
  }
  if (byReason) drawNodes(program, trees.cut());
  drawn = byReason ? trees.cut() : visible;
}

void Renderer::Impl::drawNodes(unsigned program, std::span<const TileDraw> nodes) {
  const Overlays& overlays = request->overlays;
  if (!overlays.colourByReason && !overlays.colourByLevel) return gl->trees.draw(program, nodes);
  tints.clear();
  for (const TileDraw& node : nodes)
    tints.push_back(overlays.colourByReason ? rgba(reasonColour(trees.visible().reason[node.node]), 150)
                                            : rgba(levelColour(trees.index().nodes[node.node].depth), 150));
  gl->trees.drawTinted(program, nodes, tints);
}

void Renderer::Impl::drawTreeWire(unsigned program) {
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  gl->trees.draw(program, drawn);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

/// The static trees' side of `prepare`.
void Renderer::Impl::prepareTrees(SceneView& view) {
  const FrameRequest& r = *request;
  gl->clock.lap(&FrameCost::cull);
  trees.select(r, r.frozenEye.value_or(view.eye), counters);
  gl->clock.lap(&FrameCost::select);
  paged(gl->trees.prepare(r.overlays.colourByReason ? trees.cut() : trees.visible().tiles,
                          !r.skips.tilesOnGpu));
  culling.clear();
  counters.horizon = false;
  counters.depthMap = trees.occlusion(r, counters);
  counters.depthMapsDrawn += counters.depthMap.has_value();
  if (r.overlays.tileBounds)
    addBoxes(trees.index().bounds, trees.cut(), trees.visible().reason, view.eye.position, lines);
}

/// Looking for what lacks a place, and finding that nothing does, is not paging.
void Renderer::Impl::paged(std::size_t built) {
  counters.tilesBuilt += built;
  gl->clock.lap(built > 0 ? &FrameCost::page : &FrameCost::select);
}

/// What the frame is made of: eye, visible tiles, depth map.
void Renderer::Impl::prepare(SceneView& view) {
  const FrameRequest& r = *request;
  view.shape = r.view;
  view.sky = !r.overlays.showHoles;
  view.wireframe = r.overlays.wireframe;
  view.tinted = r.overlays.colourByReason || r.overlays.colourByLevel;
  const WeatherDecision& weather = r.decision.weather;
  // What was culled is to be seen by its colour, however far it is.
  if (!r.overlays.colourByReason) view.air = airOf(weather);
  view.heightM = r.eye.height.value();
  lines.clear();
  drawn.clear();
  if (database) {
    const LocalFrame& frame = database->index().frame;
    view.eye = {frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
    view.up = frame.ecefToLocal() * eastNorthUp(r.eye.latitude, r.eye.longitude).row[2];
    view.trees = trees.wanted(r);
    view.treePicture = r.overlays.treePicture;
  }
  if (view.trees) {
    prepareTrees(view);
  } else if (database) {
    gl->clock.lap(&FrameCost::cull);
    culling.selectCut(r, r.frozenEye.value_or(view.eye), counters);
    gl->clock.lap(&FrameCost::select);
    if (culling.findHidden(r, counters)) gl->clock.lap(&FrameCost::occlusion);
    culling.selectVisible(r);
    gl->clock.lap(&FrameCost::select);
    paged(gl->tiles.prepare(r.overlays.colourByReason ? culling.cut().tiles : culling.visible().tiles,
                            !r.skips.tilesOnGpu));
    view.depth = culling.prepareOcclusion(r, gl->tiles, gl->occlusion, counters);
    gl->clock.lap(view.depth ? &FrameCost::occlusion : &FrameCost::select);
    view.oneSided = culling.eyeIsAboveGround() && !r.frozenEye;
    if (r.overlays.tileBounds)
      addBoxes(database->index().bounds, culling.cut().tiles, culling.visible().reason, view.eye.position,
               lines);
  } else {
    view.eye = {{}, eyeAxes(LocalFrame(r.eye), r.eye, r.attitude)};
    culling.clear();
    counters.depthMap.reset();
    counters.horizon = false;
  }
  view.precipitation = precipitationView(r, database ? database->index().frame : LocalFrame(r.eye));
  // What would fall where nothing does: no drop, but the effect is run.
  if (!view.precipitation && !r.skips.clearAir) view.precipitation.emplace();
  counters.precipitationPasses += view.precipitation.has_value();
  if (r.frozenEye) addFrustum(*r.frozenEye, r.view, view.eye.position, lines);
  view.lines = !lines.empty();
  constexpr double kEarthRadius = 6371e3;
  view.horizonDip = std::acos(std::min(1.0, kEarthRadius / (kEarthRadius + r.eye.height.value())));
}

/// What is done to the picture once the scene is drawn; blur before the symbols, which stay sharp.
void Renderer::Impl::finishPicture() {
  const ViewShape& v = request->view;
  const double strength = request->decision.motion.blur.strength;
  if (strength > 0 || !request->skips.blurAtRest) {
    gl->clock.beginPart(&FrameCost::blur);
    if (!(strength > 0)) gl->blur.rest();
    gl->blur.apply(gl->frame.id(), gl->frame.colourTexture(), v.widthPx, v.heightPx, strength, request->time);
    gl->clock.endPart(&FrameCost::blur);
    ++counters.blurPasses;
  }
  if (!(strength > 0)) gl->blur.rest();
  if (request->symbology && request->symbology->setup.general.enabled) {
    gl->clock.beginPart(&FrameCost::symbology);
    counters.symbologyRedraws += gl->symbology.draw(*request->symbology, v, !request->skips.sameSymbols);
    gl->clock.endPart(&FrameCost::symbology);
    ++counters.symbologyDraws;
  }
}

FrameResult Renderer::Impl::draw(const FrameRequest& r, unsigned fbo) {
  gl->clock.start(report.software, r.separateStages, r.waitForPicture);
  request = &r;
  lastView = r.view;
  SceneView view;
  prepare(view);

  gl->frame.resize(r.view.widthPx, r.view.heightPx);
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
  gl->graph.frame(view, gl->frame.id());
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
  finishPicture();

  glBindFramebuffer(GL_READ_FRAMEBUFFER, gl->frame.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, fbo);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, r.view.widthPx, r.view.heightPx, 0, 0, r.view.widthPx, r.view.heightPx,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  leaveContext(fbo);
  shown = std::move(view);
  counters.cost = gl->clock.finish();
  const bool byTrees = shown->trees;
  counters.visible = byTrees ? trees.visible() : culling.visible();
  counters.staticLod = byTrees ? trees.frame() : StaticLodFrame{};
  counters.tilesInCut = !database ? 0 : byTrees ? trees.cut().size() : culling.cut().tiles.size();
  return counters;
}

/// What others who share the context take for granted.
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
  view.depth.reset();
  view.precipitation.reset();
  view.sky = view.wireframe = view.lines = view.treePicture = false;
  std::vector<TileDraw> whole;
  numbered = unculled ? &whole : &drawn;
  if (unculled && view.trees) {
    nearView(trees.cut(), trees.index().bounds, view.eye, view.shape, whole);
    counters.tilesBuilt += gl->trees.prepare(whole);
  } else if (unculled && database) {
    nearView(culling.cut().tiles, database->index().bounds, view.eye, view.shape, whole);
    counters.tilesBuilt += gl->tiles.prepare(whole);
  }
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  gl->nodes.begin(view.shape.widthPx, view.shape.heightPx);
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
    impl_->gl = std::make_unique<Impl::Gl>(impl_->passes());
    impl_->culling.setSubpixelBits(subpixelBitsOfContext());
    impl_->gl->tiles.setDatabase(impl_->database);
    impl_->gl->trees.setTerrain(impl_->database ? impl_->database->staticLod() : nullptr);
  }
  return impl_->report;
}

void Renderer::release() {
  impl_->shown.reset();
  impl_->gl.reset();
}

void Renderer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  impl_->shown.reset();
  impl_->database = std::move(database);
  impl_->culling.setDatabase(impl_->database);
  const auto trees = impl_->database ? impl_->database->staticLod() : nullptr;
  impl_->trees.setTerrain(trees);
  if (!impl_->gl) return;
  impl_->gl->tiles.setDatabase(impl_->database);
  impl_->gl->trees.setTerrain(trees);
}

FrameResult Renderer::draw(const FrameRequest& request, unsigned fbo) {
  if (!impl_->gl || request.view.widthPx <= 0 || request.view.heightPx <= 0) return {};
  return impl_->draw(request, fbo);
}

std::vector<float> Renderer::readDistances() {
  if (!impl_->gl) return {};
  return impl_->gl->frame.readDistances(impl_->lastView);
}

Renderer::Grey Renderer::readDepthMap() {
  if (!impl_->gl) return {};
  if (impl_->counters.staticLod.drawn) {
    if (!impl_->counters.depthMap) return {};
    const DepthPyramid& map = impl_->gl->treeOcclusion.pyramid();
    return greyOf(map.depths(), map.width(), map.height(), impl_->lastView.nearM);
  }
  return impl_->culling.readDepthMap(impl_->gl->occlusion);
}

void Renderer::plant(const Defects& defects) {
  impl_->culling.plant(defects);
  impl_->trees.plant(defects);
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
