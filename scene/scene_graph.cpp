#include "trimtab/scene/scene_graph.h"

#include <osg/ClipControl>
#include <osg/Depth>
#include <osg/Drawable>
#include <osg/GLObjects>
#include <osg/Program>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/shaders.h"

namespace trimtab::scene {
namespace {

constexpr std::array<float, 3> kHaze{0.74f, 0.80f, 0.86f};
constexpr float kHazeDistance = 160e3f;

/// A drawable that is nothing but a call.
class Pass final : public osg::Drawable {
 public:
  Pass() = default;
  Pass(const Pass& other, const osg::CopyOp& op) : osg::Drawable(other, op), draw_(other.draw_) {}
  explicit Pass(std::function<void()> draw) : draw_(std::move(draw)) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setCullingActive(false);
  }
  META_Object(trimtab, Pass)

      void drawImplementation(osg::RenderInfo&) const override {
    if (draw_) draw_();
  }

 private:
  std::function<void()> draw_;
};

class Begin final : public osg::Camera::DrawCallback {
 public:
  explicit Begin(std::function<void()> call) : call_(std::move(call)) {}
  void operator()(osg::RenderInfo&) const override {
    if (call_) call_();
  }

 private:
  std::function<void()> call_;
};

osg::ref_ptr<osg::Program> makeProgram(const char* vertex, const char* fragment) {
  osg::ref_ptr<osg::Program> program = new osg::Program;
  program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
  program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
  program->addBindAttribLocation("vertexPosition", 0);
  program->addBindAttribLocation("vertexNormal", 1);
  program->addBindAttribLocation("vertexSlope", 2);
  program->addBindAttribLocation("vertexColour", 3);
  return program;
}

osg::Matrixd rotationOf(const Mat3& axes) {
  osg::Matrixd m;
  for (int i = 0; i < 3; ++i) {
    const Vec3& row = axes.row[static_cast<std::size_t>(i)];
    m(0, i) = row.x;
    m(1, i) = row.y;
    m(2, i) = row.z;
  }
  return m;
}

/// Depth is near / distance: 1 at the near plane, 0 at infinity (with zero-to-one clip control).
osg::Matrixd reversedProjection(const ViewShape& v) {
  return {2 / (v.right - v.left),
          0,
          0,
          0,
          0,
          2 / (v.top - v.bottom),
          0,
          0,
          (v.right + v.left) / (v.right - v.left),
          (v.top + v.bottom) / (v.top - v.bottom),
          0,
          -1,
          0,
          0,
          v.nearM,
          0};
}

osg::Vec3f toFloat(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

osg::Uniform* vec3(const char* name) {
  return new osg::Uniform(osg::Uniform::FLOAT_VEC3, name);
}

}  // namespace

struct SceneGraph::Nodes {
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window = new osgViewer::GraphicsWindowEmbedded(0, 0, 1, 1);
  osg::ref_ptr<osg::Group> root = new osg::Group;
  osg::ref_ptr<Pass> terrain, wire, lines, sky;

  osg::ref_ptr<osg::Uniform> eyeHi = new osg::Uniform(osg::Uniform::INT_VEC3, "eyeHi");
  osg::ref_ptr<osg::Uniform> eyeLo = vec3("eyeLo"), up = vec3("up"), upInEye = vec3("upInEye");
  osg::ref_ptr<osg::Uniform> tangents = new osg::Uniform(osg::Uniform::FLOAT_VEC4, "tangents");
  osg::ref_ptr<osg::Uniform> dip = new osg::Uniform("dip", 0.0f);
  osg::ref_ptr<osg::Uniform> tinted = new osg::Uniform("tinted", false);

  explicit Nodes(ScenePasses& passes) {
    makeState();
    terrain = add(new Pass(std::move(passes.terrain)), 1, makeProgram(kTerrainVertex, kTerrainFragment));
    terrain->getOrCreateStateSet()->addUniform(new osg::Uniform("wire", false));
    wire = add(new Pass(std::move(passes.wire)), 2, makeProgram(kTerrainVertex, kTerrainFragment));
    wire->getOrCreateStateSet()->addUniform(new osg::Uniform("wire", true));
    lines = add(new Pass(std::move(passes.lines)), 3, makeProgram(kLineVertex, kLineFragment));
    sky = add(new Pass([] { glDrawArrays(GL_TRIANGLES, 0, 3); }), 4, makeProgram(kSkyVertex, kSkyFragment));
    // Where nothing was drawn depth still is 0, infinitely far.
    sky->getOrCreateStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL, 0, 1, false));

    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setCullingMode(osg::CullSettings::NO_CULLING);
    camera->setClearDepth(0);
    camera->setInitialDrawCallback(new Begin(std::move(passes.begin)));
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setReleaseContextAtEndOfFrameHint(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    viewer->setKeyEventSetsDone(0);
    viewer->setSceneData(root);
  }

  Pass* add(Pass* pass, int order, const osg::ref_ptr<osg::Program>& program) {
    pass->getOrCreateStateSet()->setAttributeAndModes(program);
    pass->getOrCreateStateSet()->setRenderBinDetails(order, "RenderBin");
    root->addChild(pass);
    return pass;
  }

  void makeState() {
    root->setCullingActive(false);
    osg::StateSet* state = root->getOrCreateStateSet();
    state->setAttributeAndModes(
        new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
    state->setAttributeAndModes(new osg::Depth(osg::Depth::GREATER, 0, 1, true));
    for (const GLenum off : {GL_LIGHTING, GL_BLEND, GL_CULL_FACE, GL_ALPHA_TEST})
      state->setMode(off, osg::StateAttribute::OFF);
    const Vec3 towardsSun = normalized({0.45, -0.60, 0.66});
    for (osg::Uniform* uniform : {eyeHi.get(), eyeLo.get(), up.get(), upInEye.get(), tangents.get(),
                                  dip.get(), tinted.get(), new osg::Uniform("sun", toFloat(towardsSun)),
                                  new osg::Uniform("haze", osg::Vec3f(kHaze[0], kHaze[1], kHaze[2])),
                                  new osg::Uniform("hazeDistance", kHazeDistance),
                                  new osg::Uniform("slots", kSlotUnit), new osg::Uniform("tints", kTintUnit)})
      state->addUniform(uniform);
  }
};

SceneGraph::SceneGraph(ScenePasses passes) : nodes_(std::make_unique<Nodes>(passes)) {}

SceneGraph::~SceneGraph() {
  osg::State* state = nodes_->window->getState();
  nodes_->root->releaseGLObjects(state);
  nodes_->viewer->getCamera()->releaseGLObjects(state);
  // While the window lives: with the last window of a context, OSG forgets the context's lists.
  osg::flushAllDeletedGLObjects(state->getContextID());
}

void SceneGraph::frame(const SceneView& view, unsigned fbo) {
  Nodes& n = *nodes_;
  // The eye in whole units of 16 m and a rest of at most 8 m: relativePosition in shaders.cpp says why.
  const Vec3 p = view.eye.position;
  const std::array<int, 3> hi{static_cast<int>(std::lround(p.x / 16)),
                              static_cast<int>(std::lround(p.y / 16)),
                              static_cast<int>(std::lround(p.z / 16))};
  n.eyeHi->set(hi[0], hi[1], hi[2]);
  n.eyeLo->set(toFloat(p - Vec3{16.0 * hi[0], 16.0 * hi[1], 16.0 * hi[2]}));
  n.up->set(toFloat(view.up));
  n.upInEye->set(toFloat(view.eye.axes * view.up));
  n.tangents->set(osg::Vec4f(static_cast<float>(view.shape.left), static_cast<float>(view.shape.right),
                             static_cast<float>(view.shape.bottom), static_cast<float>(view.shape.top)));
  n.dip->set(static_cast<float>(view.horizonDip));
  n.tinted->set(view.tinted);
  n.sky->setNodeMask(view.sky ? ~0u : 0u);
  n.wire->setNodeMask(view.wireframe ? ~0u : 0u);
  n.lines->setNodeMask(view.lines ? ~0u : 0u);

  osg::Camera* camera = n.viewer->getCamera();
  camera->setViewport(0, 0, view.shape.widthPx, view.shape.heightPx);
  camera->setViewMatrix(rotationOf(view.eye.axes));
  camera->setProjectionMatrix(reversedProjection(view.shape));
  camera->setClearColor(view.sky ? osg::Vec4(kHaze[0], kHaze[1], kHaze[2], 1) : osg::Vec4(1, 0, 1, 1));
  n.window->setDefaultFboId(fbo);

  // Whoever shares the context (a widget's painter) has changed state behind OSG's back. State::dirtyAllModes
  // only flips what OSG believes, so what is true and what is believed are brought together here.
  osg::State* state = n.window->getState();
  for (const GLenum off : {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_DEPTH_TEST,
                           GL_LIGHTING, GL_ALPHA_TEST, GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB}) {
    glDisable(off);
    state->haveAppliedMode(off, false);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  state->dirtyAllAttributes();
  state->dirtyAllVertexArrays();
  state->setLastAppliedProgramObject(nullptr);
  n.viewer->frame();
}

}  // namespace trimtab::scene
