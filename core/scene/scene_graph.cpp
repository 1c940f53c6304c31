#include "scene_graph.h"

#include <osg/ClipControl>
#include <osg/Depth>
#include <osg/Drawable>
#include <osg/GLObjects>
#include <osg/Program>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <array>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/guard_band.h"
#include "core/scene/shaders/shaders.h"
#include "core/scene/terrain/ground/sun.h"

namespace trimtab::scene {
namespace {

/// Texels a side of the pyramid's level that a box is held against: more see more hidden, and cost more.
constexpr int kTestedSpan = 8;

unsigned programInUse(osg::State& state) {
  const auto* program = state.getLastAppliedProgramObject();
  return program ? program->getHandle() : 0;
}

/// A drawable that is nothing but a call.
class Pass final : public osg::Drawable {
 public:
  Pass() = default;
  Pass(const Pass& other, const osg::CopyOp& op) : osg::Drawable(other, op), draw_(other.draw_) {}
  explicit Pass(ScenePasses::Call draw) : draw_(std::move(draw)) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setCullingActive(false);
  }
  META_Object(trimtab, Pass);

  void drawImplementation(osg::RenderInfo& info) const override {
    if (draw_) draw_(programInUse(*info.getState()));
  }

 private:
  ScenePasses::Call draw_;
};

class Begin final : public osg::Camera::DrawCallback {
 public:
  explicit Begin(ScenePasses::Call call) : call_(std::move(call)) {}
  void operator()(osg::RenderInfo&) const override {
    if (call_) call_(0);
  }

 private:
  ScenePasses::Call call_;
};

osg::ref_ptr<osg::Program> makeProgram(const std::string& vertex, const std::string& fragment) {
  osg::ref_ptr<osg::Program> program = new osg::Program;
  program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
  program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragment));
  program->addBindAttribLocation("vertexPosition", 0);
  program->addBindAttribLocation("vertexNormal", 1);
  program->addBindAttribLocation("vertexPost", 2);
  program->addBindAttribLocation("vertexColour", 3);
  return program;
}

Pass* addPass(osg::Group* group, ScenePasses::Call call, int order, const ShaderPair& shaders) {
  Pass* pass = new Pass(std::move(call));
  osg::StateSet* state = pass->getOrCreateStateSet();
  state->setAttributeAndModes(makeProgram(shaders.vertex, shaders.fragment));
  state->setRenderBinDetails(order, "RenderBin");
  group->addChild(pass);
  return pass;
}

/// Adds a call at a place in the frame; nothing is drawn by it.
Pass* addMark(osg::Group* group, ScenePasses::Call call, int order) {
  Pass* pass = new Pass(std::move(call));
  pass->getOrCreateStateSet()->setRenderBinDetails(order, "RenderBin");
  group->addChild(pass);
  return pass;
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
  osg::Matrixd m = osg::Matrixd::scale(2 / (v.right - v.left), 2 / (v.top - v.bottom), 0);
  m(2, 0) = (v.right + v.left) / (v.right - v.left);
  m(2, 1) = (v.top + v.bottom) / (v.top - v.bottom);
  m(2, 3) = -1;
  m(3, 2) = v.nearM;
  m(3, 3) = 0;
  return m;
}

osg::Vec4f tangentsOf(const ViewShape& v) {
  return {static_cast<float>(v.left), static_cast<float>(v.right), static_cast<float>(v.bottom),
          static_cast<float>(v.top)};
}

constexpr std::array kForms{TerrainForm::levels, TerrainForm::patches, TerrainForm::static_trees};

using Type = osg::Uniform::Type;

/// Uniforms by name, made on first use.
class Uniforms {
 public:
  explicit Uniforms(osg::StateSet* state) : state_(state) {}
  template <class... Values>
  void set(const char* name, Type type, const Values&... values) {
    state_->getOrCreateUniform(name, type)->set(values...);
  }
  /// The eye is given in whole units of 16 m and a rest of at most 8 m: relative_position.glsl says why.
  void setEye(Vec3 p) {
    const auto whole = [](double x) { return static_cast<int>(std::lround(x / 16)); };
    const int x = whole(p.x), y = whole(p.y), z = whole(p.z);
    set("eyeHi", Type::INT_VEC3, x, y, z);
    set("eyeLo", Type::FLOAT_VEC3, toFloat(p - Vec3{16.0 * x, 16.0 * y, 16.0 * z}));
  }

 private:
  osg::StateSet* state_;
};

/// Chooses the shaders that are compiled with a `#define` or without it.
void define(osg::StateSet* state, const char* name, bool on) {
  if (on)
    state->setDefine(name);
  else
    state->removeDefine(name);
}

/// Returns how far the corner of a pixel is from its centre, at distance 1.
double halfDiagonal(const ViewShape& v, int widthPx, int heightPx) {
  return 0.5 * std::hypot((v.right - v.left) / widthPx, (v.top - v.bottom) / heightPx);
}

}  // namespace

osg::Vec3f toFloat(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

struct SceneGraph::Nodes {
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window = new osgViewer::GraphicsWindowEmbedded(0, 0, 1, 1);
  osg::ref_ptr<osg::Group> root = new osg::Group;
  osg::ref_ptr<osg::Camera> depthCamera = new osg::Camera;
  struct FormPasses {
    osg::ref_ptr<Pass> surface, wire, numbers;
  };
  std::array<FormPasses, kForms.size()> forms;
  osg::ref_ptr<Pass> treePicture, lines, sky;
  osg::ref_ptr<Pass> beforeWeather, afterWeather;
  PrecipitationNode precipitation;
  bool begun = false;    ///< this frame's drawing
  ViewShape drawnShape;  ///< the frame's
  int guardBand = 1;

  explicit Nodes(ScenePasses& passes) {
    makeState();
    makeDepthCamera(passes);
    // A camera that is drawn first, is drawn before the main one's callback too: whichever comes first
    // counts.
    const osg::ref_ptr<Begin> begin = new Begin([this, call = std::move(passes.begin)](unsigned program) {
      if (!begun) call(program);
      begun = true;
    });
    depthCamera->setInitialDrawCallback(begin);
    viewer->getCamera()->setInitialDrawCallback(begin);
    for (const TerrainForm form : kForms) {
      FormPasses& of = forms[static_cast<std::size_t>(form)];
      const ShaderPair shaders = terrainShaders(form);
      const auto inBand = [this](const ScenePasses::Call& call) -> ScenePasses::Call {
        return [this, call](unsigned program) {
          const WideViewport wide(drawnShape, guardBand);
          if (call) call(program);
        };
      };
      of.surface = addPass(root, inBand(passes.surface), 1, shaders);
      of.wire = addPass(root, inBand(passes.wire), 2, shaders);
      of.wire->getStateSet()->setDefine("WIRE");
      of.numbers = addPass(root, inBand(passes.numbers), 1, terrainShaders(form, true));
    }
    treePicture =
        addPass(root, std::move(passes.treePicture), 1, shaderPair("tree_flat.vert.glsl", "line.frag.glsl"));
    lines = addPass(root, std::move(passes.lines), 3, shaderPair("line.vert.glsl", "line.frag.glsl"));
    sky = addPass(
        root, [](unsigned) { glDrawArrays(GL_TRIANGLES, 0, 3); }, 4,
        shaderPair("screen.vert.glsl", "sky.frag.glsl"));
    // Where nothing was drawn, depth still is 0, infinitely far.
    sky->getStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL, 0, 1, false));

    root->addChild(precipitation.node());
    beforeWeather = addMark(root, std::move(passes.beforeWeather), PrecipitationNode::kFirstBin - 1);
    afterWeather = addMark(root, std::move(passes.afterWeather), PrecipitationNode::kLastBin + 1);

    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setCullingMode(osg::CullSettings::NO_CULLING);
    camera->setClearDepth(0);
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setReleaseContextAtEndOfFrameHint(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    viewer->setKeyEventSetsDone(0);
    viewer->setSceneData(root);
  }

  void makeState() {
    root->setCullingActive(false);
    osg::StateSet* state = root->getOrCreateStateSet();
    state->setAttributeAndModes(
        new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
    state->setAttributeAndModes(new osg::Depth(osg::Depth::GREATER, 0, 1, true));
    for (const GLenum off : {GL_LIGHTING, GL_BLEND, GL_CULL_FACE, GL_ALPHA_TEST})
      state->setMode(off, osg::StateAttribute::OFF);
    Uniforms uniforms(state);
    uniforms.set("sun", Type::FLOAT_VEC3, toFloat(normalized(kTowardsSun)));
    uniforms.set("slots", Type::INT, kSlotUnit);
    uniforms.set("tints", Type::INT, kTintUnit);
  }

  /// Makes the papers' z-map camera: subordinate to the main one, with its matrices, drawn before it in the
  /// same frame. Its framebuffer is the passes' own.
  void makeDepthCamera(ScenePasses& passes) {
    depthCamera->setRenderOrder(osg::Camera::PRE_RENDER);
    depthCamera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    depthCamera->setClearMask(0);
    depthCamera->setCullingActive(false);
    depthCamera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    depthCamera->setCullingMode(osg::CullSettings::NO_CULLING);
    Uniforms uniforms(depthCamera->getOrCreateStateSet());
    uniforms.set("source", Type::INT, kDepthUnit);
    uniforms.set("depthMap", Type::INT, kDepthUnit);
    uniforms.set("pyramid", Type::INT, kPyramidUnit);
    uniforms.set("parts", Type::INT, kPartUnit);
    uniforms.set("tested", Type::INT, kTestedUnit);
    uniforms.set("span", Type::INT, kTestedSpan);
    // Far sides of mountains hide next to nothing that their near sides do not: without them the pass costs
    // less than the few more tiles that are drawn.
    addPass(depthCamera, std::move(passes.occluders), 1,
            shaderPair("occluder.vert.glsl", "occluder.frag.glsl"))
        ->getStateSet()
        ->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    addPass(depthCamera, std::move(passes.reduce), 2,
            shaderPair("screen.vert.glsl", "depth_reduce.frag.glsl"))
        ->getStateSet()
        ->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    addPass(depthCamera, std::move(passes.test), 3,
            shaderPair("screen.vert.glsl", "occlusion_test.frag.glsl"))
        ->getStateSet()
        ->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    root->addChild(depthCamera);
  }

  void setDepthView(const DepthView& depth, const ViewShape& shape) {
    depthCamera->setViewport(0, 0, depth.widthPx, depth.heightPx);
    depthCamera->setViewMatrix(rotationOf(depth.eye.axes));
    depthCamera->setProjectionMatrix(reversedProjection(shape));
    Uniforms uniforms(depthCamera->getStateSet());
    uniforms.setEye(depth.eye.position);
    uniforms.set("right", Type::FLOAT_VEC3, toFloat(depth.eye.axes.row[0]));
    uniforms.set("up", Type::FLOAT_VEC3, toFloat(depth.eye.axes.row[1]));
    uniforms.set("forward", Type::FLOAT_VEC3, toFloat(-depth.eye.axes.row[2]));
    uniforms.set("nearM", Type::FLOAT, static_cast<float>(shape.nearM));
    uniforms.set("mapSize", Type::INT_VEC2, depth.widthPx, depth.heightPx);
    uniforms.set("levels", Type::INT, depth.levels);
    uniforms.set("count", Type::INT, depth.tiles);
    // Rasterisers snap vertices to a fraction of a pixel, in the image and in the map: a tenth covers both.
    const double texel = halfDiagonal(shape, depth.widthPx, depth.heightPx);
    const double pixel = halfDiagonal(shape, shape.widthPx, shape.heightPx);
    uniforms.set("texelReach", Type::FLOAT, static_cast<float>(texel * 1.04 + pixel * 0.1));
    const auto pad = [](int map, int picture) {
      return 0.05f + 0.1f * static_cast<float>(map) / static_cast<float>(picture);
    };
    uniforms.set("pad", Type::FLOAT_VEC2,
                 osg::Vec2f(pad(depth.widthPx, shape.widthPx), pad(depth.heightPx, shape.heightPx)));
    uniforms.set("loweringScale", Type::FLOAT, static_cast<float>(depth.loweringScale));
    uniforms.set("shift", Type::FLOAT, static_cast<float>(depth.shiftTexels));
  }

  /// Undoes what others who share the context (a widget's painter) changed behind OSG's back.
  /// State::dirtyAllModes only flips what OSG believes, so this brings that and the true state together.
  void settleState() {
    osg::State* state = window->getState();
    for (const GLenum off :
         {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_CULL_FACE, GL_DEPTH_TEST, GL_LIGHTING, GL_ALPHA_TEST,
          GL_DEPTH_CLAMP, GL_FRAMEBUFFER_SRGB, GL_VERTEX_PROGRAM_POINT_SIZE}) {
      glDisable(off);
      state->haveAppliedMode(off, false);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    state->dirtyAllAttributes();
    state->dirtyAllVertexArrays();
    state->setLastAppliedProgramObject(nullptr);
  }
};

/// Clear weather has shaders of its own, which know nothing of fog, and so have fog without a cut and fog
/// that is not a layer: nothing is paid for what the air is not.
void SceneGraph::setAir(const SceneView& view) {
  osg::StateSet* state = nodes_->root->getOrCreateStateSet();
  const Air& air = view.air;
  define(state, "IN_WEATHER", !air.clear);
  define(state, "AIR_CUT", !air.clear && air.cutM < Air::kFarthest);
  define(state, "AIR_LAYER", !air.clear && air.layered);
  if (air.clear) return;
  Uniforms uniforms(state);
  uniforms.set("fog", Type::FLOAT_VEC3, osg::Vec3f(air.colour[0], air.colour[1], air.colour[2]));
  uniforms.set("air", Type::FLOAT_VEC3, osg::Vec3f(air.extinction, air.cutM, air.fadePerM));
  uniforms.set("fogDepth", Type::FLOAT_VEC2,
               osg::Vec2f(static_cast<float>(kFogTopM), static_cast<float>(std::max(view.heightM, 1.0))));
  if (!air.layered) return;
  const LayerRoots roots = layerRoots(view.heightM, double{air.topM});
  uniforms.set("upInFrame", Type::FLOAT_VEC3, toFloat(view.up));
  uniforms.set("layer", Type::FLOAT_VEC2,
               osg::Vec2f(static_cast<float>(roots.fromCentre), static_cast<float>(roots.top)));
  uniforms.set("lowest", Type::FLOAT, static_cast<float>(roots.lowest));
}

SceneGraph::SceneGraph(ScenePasses passes) : nodes_(std::make_unique<Nodes>(passes)) {}

SceneGraph::~SceneGraph() {
  osg::State* state = nodes_->window->getState();
  nodes_->root->releaseGLObjects(state);
  nodes_->viewer->getCamera()->releaseGLObjects(state);
  // The objects are flushed while the window lives: with the last window of a context, OSG forgets the
  // context's lists.
  osg::flushAllDeletedGLObjects(state->getContextID());
}

void SceneGraph::frame(const SceneView& view, unsigned fbo) {
  Nodes& n = *nodes_;
  Uniforms uniforms(n.root->getStateSet());
  uniforms.setEye(view.eye.position);
  uniforms.set("upInEye", Type::FLOAT_VEC3, toFloat(view.eye.axes * view.up));
  uniforms.set("tangents", Type::FLOAT_VEC4, tangentsOf(view.shape));
  uniforms.set("dip", Type::FLOAT, static_cast<float>(view.horizonDip));
  uniforms.set("textureSquares", Type::BOOL, view.textureSquares);
  uniforms.set("inGuardBand", Type::FLOAT, 1.0f / static_cast<float>(view.guardBand));
  n.drawnShape = view.shape, n.guardBand = view.guardBand;
  osg::StateSet* state = n.root->getOrCreateStateSet();
  define(state, "GROUND_TEXTURE", view.groundTexture);
  define(state, "TINTED", view.tinted);
  define(state, "ON_GRID", view.gridStepsPerPixel > 0);
  if (view.gridStepsPerPixel > 0) {
    const double steps = 0.5 * view.guardBand * view.gridStepsPerPixel;
    uniforms.set("gridSteps", Type::FLOAT_VEC2,
                 osg::Vec2f(static_cast<float>(steps * view.shape.widthPx),
                            static_cast<float>(steps * view.shape.heightPx)));
  }
  const auto show = [](Pass& pass, bool on) { pass.setNodeMask(on ? ~0u : 0u); };
  for (const TerrainForm form : kForms) {
    const Nodes::FormPasses& of = n.forms[static_cast<std::size_t>(form)];
    const bool drawn = view.form == form && !view.treePicture;
    show(*of.surface, drawn && !view.nodes);
    show(*of.wire, drawn && view.wireframe);
    show(*of.numbers, drawn && view.nodes);
    for (Pass* pass : {of.surface.get(), of.numbers.get()})
      pass->getStateSet()->setMode(GL_CULL_FACE,
                                   view.oneSided ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
  }
  show(*n.treePicture, view.treePicture);
  show(*n.sky, view.sky);
  show(*n.lines, view.lines);
  const bool effect = view.precipitation && view.precipitation->form == PrecipitationForm::effect;
  show(*n.beforeWeather, effect);
  show(*n.afterWeather, effect);
  n.depthCamera->setNodeMask(view.depth ? ~0u : 0u);
  if (view.depth) n.setDepthView(*view.depth, view.shape);
  setAir(view);
  n.precipitation.set(view.precipitation, view);

  osg::Camera* camera = n.viewer->getCamera();
  camera->setViewport(0, 0, view.shape.widthPx, view.shape.heightPx);
  camera->setViewMatrix(rotationOf(view.eye.axes));
  camera->setProjectionMatrix(reversedProjection(view.shape));
  // An integer framebuffer has no colour that a camera could clear.
  camera->setClearMask(view.nodes ? GL_DEPTH_BUFFER_BIT : GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
  camera->setClearColor(view.sky ? osg::Vec4(kHaze[0], kHaze[1], kHaze[2], 1) : osg::Vec4(1, 0, 1, 1));
  n.window->setDefaultFboId(fbo);
  n.settleState();
  n.begun = view.nodes;
  n.viewer->frame();
  if (effect) n.settleState();  // its modes are nobody else's
}

}  // namespace trimtab::scene
