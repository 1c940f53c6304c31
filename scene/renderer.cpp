#include "trimtab/scene/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "trimtab/scene/blur_pass.h"
#include "trimtab/scene/frame_buffer.h"
#include "trimtab/scene/frame_culling.h"
#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/scene/gpu_timer.h"
#include "trimtab/scene/lines.h"
#include "trimtab/scene/occlusion.h"
#include "trimtab/scene/scene_graph.h"
#include "trimtab/scene/shaders.h"
#include "trimtab/scene/static_lod_culling.h"
#include "trimtab/scene/static_lod_layer.h"
#include "trimtab/scene/static_lod_occlusion.h"
#include "trimtab/scene/symbology_pass.h"
#include "trimtab/scene/tile_cache.h"
#include "trimtab/scene/weather_precipitation.h"

namespace trimtab::scene {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double millisecondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

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
  FrameCost cost;
  Clock::time_point frameStart, cullDone, drawStart;
  std::vector<TileDraw> drawn;
  std::vector<std::uint32_t> tints;
  std::vector<LineVertex> lines;

  /// Everything that lives in the context.
  struct Gl {
    explicit Gl(ScenePasses passes) : graph(std::move(passes)) {}
    FrameBuffer frame;
    TileCache tiles;
    StaticLodLayer trees;
    StaticLodOcclusion treeOcclusion;
    OcclusionPass occlusion;
    LineBuffer lineBuffer;
    BlurPass blur;
    SymbologyPass symbology;
    GpuTimer timer;
    SceneGraph graph;
  };
  std::unique_ptr<Gl> gl;

  ScenePasses passes() {
    return {
        .begin = [this](unsigned) { cullDone = drawStart = Clock::now(); },
        .occluders = [this](unsigned) { drawOccluders(); },
        .reduce = [this](unsigned program) { gl->occlusion.reduce(program); },
        .test = [this](unsigned) { removeHidden(); },
        .terrain = [this](unsigned) { drawTerrain(); },
        .wire = [this](unsigned) { drawWire(); },
        .trees = [this](unsigned program) { drawTrees(program); },
        .treeWire = [this](unsigned program) { drawTreeWire(program); },
        .treePicture = [this](unsigned program) { gl->trees.drawPicture(program, trees.visible().tiles); },
        .lines = [this](unsigned) { gl->lineBuffer.draw(lines); }};
  }

  void drawOccluders();
  void removeHidden();
  void drawTerrain();
  void drawWire();
  void drawTrees(unsigned program);
  void drawNodes(unsigned program, std::span<const TileDraw> nodes);
  void drawTreeWire(unsigned program);
  void prepareTrees(SceneView& view);
  void bindTileTextures(bool on);
  void prepare(SceneView& view);
  void finishPicture();
  FrameResult draw(const FrameRequest& r, unsigned fbo);
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
  drawStart = Clock::now();
  cost.occlusion = millisecondsBetween(cullDone, drawStart);
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
  bindTileTextures(true);
  gl->tiles.draw(drawn);
  bindTileTextures(false);
}

void Renderer::Impl::drawWire() {
  bindTileTextures(true);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  gl->tiles.draw(drawn);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  bindTileTextures(false);
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
    const auto start = Clock::now();
    const ViewShape& v = request->view;
    gl->treeOcclusion.read(v.widthPx, v.heightPx, counters.depthMap->widthPx, counters.depthMap->heightPx);
    trees.removeHidden(gl->treeOcclusion.pyramid());
    cost.occlusion = millisecondsBetween(start, Clock::now());
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
  const auto start = Clock::now();
  trees.select(r, r.frozenEye.value_or(view.eye), counters);
  cost.select = millisecondsBetween(start, Clock::now());
  counters.tilesBuilt += gl->trees.prepare(r.overlays.colourByReason ? trees.cut() : trees.visible().tiles);
  culling.clear();
  counters.depthMap = trees.occlusion(r, counters);
  counters.depthMapsDrawn += counters.depthMap.has_value();
  if (r.overlays.tileBounds)
    addBoxes(trees.index().bounds, trees.cut(), trees.visible().reason, view.eye.position, lines);
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
    const auto start = Clock::now();
    culling.select(r, r.frozenEye.value_or(view.eye), counters);
    cost.select = millisecondsBetween(start, Clock::now());
    counters.tilesBuilt +=
        gl->tiles.prepare(r.overlays.colourByReason ? culling.cut().tiles : culling.visible().tiles);
    view.depth = culling.prepareOcclusion(r, gl->tiles, gl->occlusion, counters);
    view.oneSided = culling.eyeIsAboveGround() && !r.frozenEye;
    if (r.overlays.tileBounds)
      addBoxes(database->index().bounds, culling.cut().tiles, culling.visible().reason, view.eye.position,
               lines);
  } else {
    view.eye = {{}, eyeAxes(LocalFrame(r.eye), r.eye, r.attitude)};
    culling.clear();
    counters.depthMap.reset();
  }
  view.precipitation = precipitationView(r, database ? database->index().frame : LocalFrame(r.eye));
  counters.precipitationPasses += view.precipitation.has_value();
  if (r.frozenEye) addFrustum(*r.frozenEye, r.view, view.eye.position, lines);
  view.lines = !lines.empty();
  constexpr double kEarthRadius = 6371e3;
  view.horizonDip = std::acos(std::min(1.0, kEarthRadius / (kEarthRadius + r.eye.height.value())));
}

/// What is done to the picture once the scene is drawn; blur before the symbols, which stay sharp.
void Renderer::Impl::finishPicture() {
  const ViewShape& v = request->view;
  if (const double strength = request->decision.motion.blur.strength; strength > 0) {
    gl->blur.apply(gl->frame.id(), gl->frame.colourTexture(), v.widthPx, v.heightPx, strength, request->time);
    ++counters.blurPasses;
  } else {
    gl->blur.rest();
  }
  if (request->symbology && request->symbology->setup.general.enabled) {
    counters.symbologyRedraws += gl->symbology.draw(*request->symbology, v);
    ++counters.symbologyDraws;
  }
}

FrameResult Renderer::Impl::draw(const FrameRequest& r, unsigned fbo) {
  const auto start = Clock::now();
  request = &r;
  lastView = r.view;
  cost = {kNone, 0, kNone, 0, 0, kNone, 0};
  SceneView view;
  prepare(view);

  gl->timer.begin();
  gl->frame.resize(r.view.widthPx, r.view.heightPx);
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
  frameStart = Clock::now();
  gl->graph.frame(view, gl->frame.id());
  glBindFramebuffer(GL_FRAMEBUFFER, gl->frame.id());
  finishPicture();

  glBindFramebuffer(GL_READ_FRAMEBUFFER, gl->frame.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, fbo);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, r.view.widthPx, r.view.heightPx, 0, 0, r.view.widthPx, r.view.heightPx,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  // What others who share the context take for granted.
  glBindFramebuffer(GL_FRAMEBUFFER, fbo);
  glUseProgram(0);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND}) glDisable(off);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glClearDepth(1);
  gl->timer.end();
  // A software rasteriser works on after the calls return; without waiting its cost would show up anywhere.
  if (report.software) glFinish();

  const auto end = Clock::now();
  cost.cull = millisecondsBetween(frameStart, cullDone);
  cost.draw = millisecondsBetween(drawStart, end);
  // The trees' depth map is read while they are drawn.
  if (view.trees && counters.depthMap) cost.draw -= cost.occlusion;
  // A software rasteriser's GPU is this processor: its time is in `draw` already, and would count twice.
  cost.gpu = report.software ? std::numeric_limits<double>::quiet_NaN() : gl->timer.milliseconds();
  cost.total = millisecondsBetween(start, end);
  counters.visible = view.trees ? trees.visible() : culling.visible();
  counters.staticLod = view.trees ? trees.frame() : StaticLodFrame{};
  counters.cost = cost;
  counters.tilesInCut = !database ? 0 : view.trees ? trees.cut().size() : culling.cut().tiles.size();
  return counters;
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

GlReport Renderer::initialize() {
  release();
  impl_->report = reportContext();
  if (impl_->report.usable) {
    impl_->gl = std::make_unique<Impl::Gl>(impl_->passes());
    impl_->gl->tiles.setDatabase(impl_->database);
    impl_->gl->trees.setTerrain(impl_->database ? impl_->database->staticLod() : nullptr);
  }
  return impl_->report;
}

void Renderer::release() {
  impl_->gl.reset();
}

void Renderer::setTerrain(std::shared_ptr<const terrain::Database> database) {
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
  std::vector<float> distances = impl_->gl->frame.readDepths();
  const ViewShape& v = impl_->lastView;
  std::size_t i = 0;
  for (int y = 0; y < v.heightPx; ++y)
    for (int x = 0; x < v.widthPx; ++x, ++i) {
      const double across = v.left + (v.right - v.left) * (x + 0.5) / v.widthPx;
      const double up = v.bottom + (v.top - v.bottom) * (y + 0.5) / v.heightPx;
      distances[i] =
          static_cast<float>(v.nearM / double{distances[i]} * std::sqrt(1 + across * across + up * up));
    }
  return distances;
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
}

std::vector<std::uint8_t> Renderer::readPixels(int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  if (!impl_->gl) return pixels;
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, impl_->gl->frame.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  return pixels;
}

}  // namespace trimtab::scene
