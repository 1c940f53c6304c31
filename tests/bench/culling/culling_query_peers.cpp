#include "culling_query_peers.h"

// Before OSG, which includes GL without prototypes.
#include "core/scene/gl/gl_api.h"

#include <osg/Depth>
#include <osg/GLObjects>
#include <osg/OcclusionQueryNode>
#include <osg/Program>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/passes/weather_air.h"
#include "core/scene/shaders/light.h"
#include "core/scene/shaders/shaders.h"
#include "core/scene/terrain/tiles/tile_cache.h"
#include "osg_view.h"
#include "tests/bench/row.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::bench {
namespace {

// Standard depth of 32 bits: nearer and farther lose mountains to rounding.
constexpr double kNear = 10, kFar = 300e3;

/// A drawable that is a bound and a call.
class Call final : public osg::Drawable {
 public:
  Call() = default;
  Call(const Call& other, const osg::CopyOp& op)
      : osg::Drawable(other, op), box_(other.box_), draw_(other.draw_) {}
  Call(const osg::BoundingBox& box, std::function<void(osg::State&)> draw)
      : box_(box), draw_(std::move(draw)) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setCullingActive(box_.valid());
  }
  META_Object(trimtab, Call);
  osg::BoundingBox computeBoundingBox() const override { return box_; }
  void drawImplementation(osg::RenderInfo& info) const override { draw_(*info.getState()); }

 private:
  osg::BoundingBox box_;
  std::function<void(osg::State&)> draw_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  if (const std::size_t at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

osg::ref_ptr<osg::Program> makeProgram(const std::string& vertex, const char* fragment) {
  osg::ref_ptr<osg::Program> program = new osg::Program;
  program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
  program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
  program->addBindAttribLocation("vertexPosition", 0);
  program->addBindAttribLocation("vertexNormal", 1);
  program->addBindAttribLocation("vertexColour", 3);
  return program;
}

osg::Vec3f toFloat(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// 12 triangles of a box.
void addBox(const Box& b, std::vector<float>& corners) {
  static constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& face : kFaces)
    for (const int i : {0, 1, 2, 0, 2, 3}) {
      const int corner = face[i];
      corners.insert(corners.end(), {corner & 1 ? b.maxX : b.minX, corner & 2 ? b.maxY : b.minY,
                                     corner & 4 ? b.maxZ : b.minZ});
    }
}

}  // namespace

struct QueryPeers::Impl {
  std::shared_ptr<const terrain::Database> database;
  std::unique_ptr<scene::Offscreen> offscreen;
  std::unique_ptr<scene::TileCache> cache;
  scene::FrameBuffer frame;
  int width, height;
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window;
  osg::ref_ptr<osg::Group> root = new osg::Group, plain = new osg::Group, nodes = new osg::Group;
  osg::ref_ptr<osg::StateSet> terrain = new osg::StateSet;
  osg::ref_ptr<Call> queries;
  // Of the frame.
  LevelCut cut;
  Vec3 upInFrame{0, 0, 1};
  EyePose eye;
  ViewShape view;
  std::size_t drawn = 0;
  // Of plain GL's queries.
  VisibleSet inView;
  std::vector<TileDraw> now;
  std::vector<std::uint8_t> seen;      ///< in the frame before, one a node
  std::vector<std::uint32_t> placeOf;  ///< in the cut, one a node
  std::vector<GLuint> names;
  GLuint boxArray = 0, boxBuffer = 0;

  Impl(int widthPx, int heightPx) : width(widthPx), height(heightPx) {
    window = new osgViewer::GraphicsWindowEmbedded(0, 0, widthPx, heightPx);
    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setViewport(0, 0, widthPx, heightPx);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
    camera->setClearColor({scene::kHaze[0], scene::kHaze[1], scene::kHaze[2], 1});
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setReleaseContextAtEndOfFrameHint(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);

    osg::StateSet* state = root->getOrCreateStateSet();
    state->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL, 0, 1, true));
    state->addUniform(new osg::Uniform("sun", toFloat(normalized({0.55, -0.60, 0.58}))));
    state->addUniform(new osg::Uniform("inGuardBand", 1.0f));
    state->addUniform(new osg::Uniform("slots", scene::kSlotUnit));
    state->addUniform(new osg::Uniform("tints", scene::kTintUnit));
    // OSG culls in the terrain's frame, the vertices are relative to the eye.
    const std::string vertex = replaced(
        replaced(scene::shaderText("terrain.vert.glsl"), "gl_ModelViewProjectionMatrix *", "relativeView *"),
        "in vec3 vertexPosition;", "uniform mat4 relativeView;\nin vec3 vertexPosition;");
    terrain->setAttributeAndModes(makeProgram(vertex, scene::shaderText("terrain.frag.glsl").c_str()));
    terrain->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    queries = new Call({}, [this](osg::State& s) { drawByQueries(s); });
    queries->setStateSet(terrain);
    osg::ref_ptr<Call> sky = new Call({}, [](osg::State&) { glDrawArrays(GL_TRIANGLES, 0, 3); });
    osg::StateSet* far = sky->getOrCreateStateSet();
    far->setAttributeAndModes(
        makeProgram(replaced(scene::shaderText("screen.vert.glsl"), "- 1.0, 0.0, 1.0)", "- 1.0, 1.0, 1.0)"),
                    scene::shaderText("sky.frag.glsl").c_str()));
    far->setAttributeAndModes(new osg::Depth(osg::Depth::LEQUAL, 0, 1, false));
    far->setRenderBinDetails(20, "RenderBin");
    for (osg::Node* child : {static_cast<osg::Node*>(plain), static_cast<osg::Node*>(nodes),
                             static_cast<osg::Node*>(queries), static_cast<osg::Node*>(sky)})
      root->addChild(child);
    viewer->setSceneData(root);
  }

  void draw(std::span<const TileDraw> tiles) {
    cache->draw(tiles);
    drawn += tiles.size();
  }

  void begin(const LevelCut& tiles, Vec3 up, double heightM) {
    cut = tiles;
    cache->prepare(cut.tiles);
    const TerrainIndex& index = database->index();
    seen.assign(index.size(), 0);
    placeOf.resize(index.size());
    std::vector<float> corners;
    for (osg::Group* group : {plain.get(), nodes.get()}) {
      group->releaseGLObjects(window->getState());
      group->removeChildren(0, group->getNumChildren());
    }
    for (std::uint32_t i = 0; i < cut.tiles.size(); ++i) {
      const TileDraw& tile = cut.tiles[i];
      const Box& box = index.bounds[tile.node];
      placeOf[tile.node] = i;
      addBox(box, corners);
      osg::ref_ptr<Call> leaf =
          new Call(boundOf(box), [this, i](osg::State&) { draw(std::span(cut.tiles).subspan(i, 1)); });
      leaf->setStateSet(terrain);
      plain->addChild(leaf);
      osg::ref_ptr<osg::OcclusionQueryNode> node = new osg::OcclusionQueryNode;
      // Else a tile of up to 500 pixels is left out.
      node->setVisibilityThreshold(0);
      node->addChild(leaf);
      nodes->addChild(node);
    }
    if (boxArray == 0) {
      glGenVertexArrays(1, &boxArray);
      glGenBuffers(1, &boxBuffer);
    }
    glBindVertexArray(boxArray);
    glBindBuffer(GL_ARRAY_BUFFER, boxBuffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(),
                 GL_STATIC_DRAW);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, nullptr);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    const std::size_t had = names.size();
    if (cut.tiles.size() > had) {
      names.resize(cut.tiles.size());
      glGenQueries(static_cast<GLsizei>(names.size() - had), names.data() + had);
    }
    upInFrame = up;
    constexpr double kEarthRadius = 6371e3;
    root->getStateSet()
        ->getOrCreateUniform("dip", osg::Uniform::FLOAT)
        ->set(static_cast<float>(std::acos(std::min(1.0, kEarthRadius / (kEarthRadius + heightM)))));
  }

  /// In two passes, and exact: what is not drawn has a box of which no pixel passed.
  void drawByQueries(osg::State& state) {
    const TerrainIndex& index = database->index();
    selectVisible(cut, {.eye = eye, .view = view}, inView);
    now.clear();
    for (const TileDraw& tile : inView.tiles)
      if (seen[tile.node]) now.push_back(tile);
    draw(now);
    const auto* program = state.getLastAppliedProgramObject();
    glUseProgram(0);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(boxArray);
    // A box that the near plane cuts shows no face.
    const double near = 4 * kNear * kNear;
    const auto isNear = [&](const TileDraw& tile) {
      return distanceSquared(index.bounds[tile.node], eye.position) < near;
    };
    for (const TileDraw& tile : inView.tiles) {
      if (isNear(tile)) continue;
      const std::uint32_t i = placeOf[tile.node];
      glBeginQuery(GL_ANY_SAMPLES_PASSED, names[i]);
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(36 * i), 36);
      glEndQuery(GL_ANY_SAMPLES_PASSED);
    }
    glBindVertexArray(0);
    glEnable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glUseProgram(program->getHandle());
    now.clear();
    for (const TileDraw& tile : inView.tiles) {
      GLuint passed = 1;
      if (!isNear(tile)) glGetQueryObjectuiv(names[placeOf[tile.node]], GL_QUERY_RESULT, &passed);
      if (passed && !seen[tile.node]) now.push_back(tile);
      seen[tile.node] = passed != 0;
    }
    draw(now);
  }

  double ms(Way way, const EyePose& at, const ViewShape& shape) {
    offscreen->makeCurrent();
    eye = at, view = shape;
    view.nearM = kNear;
    const double start = monotonicSeconds();
    drawn = 0;
    plain->setNodeMask(way == Way::none ? ~0u : 0u);
    nodes->setNodeMask(way == Way::node ? ~0u : 0u);
    queries->setNodeMask(way == Way::gl ? ~0u : 0u);
    osg::Camera* camera = viewer->getCamera();
    camera->setViewMatrix(viewOf(eye));
    camera->setProjectionMatrix(projectionOf(view, kFar));
    const auto whole = [](double x) { return static_cast<int>(std::lround(x / 16)); };
    const int x = whole(eye.position.x), y = whole(eye.position.y), z = whole(eye.position.z);
    osg::StateSet* state = root->getStateSet();
    state->getOrCreateUniform("eyeHi", osg::Uniform::INT_VEC3)->set(x, y, z);
    state->getOrCreateUniform("eyeLo", osg::Uniform::FLOAT_VEC3)
        ->set(toFloat(eye.position - Vec3{16.0 * x, 16.0 * y, 16.0 * z}));
    state->getOrCreateUniform("relativeView", osg::Uniform::FLOAT_MAT4)
        ->set(osg::Matrixf(rotationOf(eye) * projectionOf(view, kFar)));
    state->getOrCreateUniform("upInEye", osg::Uniform::FLOAT_VEC3)->set(toFloat(eye.axes * upInFrame));
    state->getOrCreateUniform("tangents", osg::Uniform::FLOAT_VEC4)
        ->set(osg::Vec4f(static_cast<float>(view.left), static_cast<float>(view.right),
                         static_cast<float>(view.bottom), static_cast<float>(view.top)));
    glActiveTexture(GL_TEXTURE0 + scene::kSlotUnit);
    glBindTexture(GL_TEXTURE_BUFFER, cache->slotTexture());
    glActiveTexture(GL_TEXTURE0);
    viewer->frame();
    glFinish();
    return 1e3 * (monotonicSeconds() - start);
  }
};

QueryPeers::QueryPeers(std::shared_ptr<const terrain::Database> database, int widthPx, int heightPx)
    : impl_(std::make_unique<Impl>(widthPx, heightPx)) {
  Impl& p = *impl_;
  auto created = scene::Offscreen::create(widthPx, heightPx);
  if (!created) return;
  p.offscreen = std::move(created).value();
  p.offscreen->makeCurrent();
  p.database = std::move(database);
  p.cache = std::make_unique<scene::TileCache>();
  p.cache->setDatabase(p.database);
  p.frame.resize(widthPx, heightPx);
  p.window->setDefaultFboId(p.frame.id());
}

QueryPeers::~QueryPeers() {
  Impl& p = *impl_;
  if (!p.offscreen) return;
  p.offscreen->makeCurrent();
  p.root->releaseGLObjects(p.window->getState());
  osg::flushAllDeletedGLObjects(p.window->getState()->getContextID());
  glDeleteQueries(static_cast<GLsizei>(p.names.size()), p.names.data());
  glDeleteBuffers(1, &p.boxBuffer);
  glDeleteVertexArrays(1, &p.boxArray);
  p.cache.reset();
  p.frame.release();
}

bool QueryPeers::ready() const {
  return impl_->offscreen != nullptr;
}

void QueryPeers::begin(const LevelCut& cut, Vec3 up, double heightM) {
  impl_->offscreen->makeCurrent();
  impl_->begin(cut, up, heightM);
}

double QueryPeers::ms(Way way, const EyePose& eye, const ViewShape& view) {
  return impl_->ms(way, eye, view);
}

std::size_t QueryPeers::drawn() const {
  return impl_->drawn;
}

}  // namespace trimtab::bench
