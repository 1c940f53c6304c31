#include "precipitation_effect.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <osg/BlendFunc>
#include <osg/ClipControl>
#include <osg/Depth>
#include <osg/GLObjects>
#include <osg/Notify>
#include <osg/PointSprite>
#include <osg/Program>
#include <osg/Texture2D>
#include <osgParticle/PrecipitationEffect>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/osg_state.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

osg::Vec3f toFloat(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

osg::ref_ptr<osg::Program> dropProgram(const std::string& vertex) {
  osg::ref_ptr<osg::Program> program = new osg::Program;
  program->addShader(new osg::Shader(osg::Shader::VERTEX, vertex));
  program->addShader(new osg::Shader(osg::Shader::FRAGMENT, shaderText("drop.frag.glsl")));
  return program;
}

/// The effect asks rand(); these are the same in every process. `copies` vertices stand for one particle.
void scatter(osg::Geometry* geometry, unsigned copies) {
  auto* vertices = static_cast<osg::Vec3Array*>(geometry->getVertexArray());
  std::mt19937 random(20140908);
  const auto unit = [&random] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
  for (std::size_t i = 0; i + copies <= vertices->size(); i += copies) {
    const float x = unit(), y = unit(), z = unit();
    for (unsigned copy = 0; copy < copies; ++copy) (*vertices)[i + copy].set(x, y, z);
  }
  vertices->dirty();
}

float fraction(double x) {
  return std::isfinite(x) ? static_cast<float>(x - std::floor(x)) : 0.f;
}

bool isFinite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

struct PrecipitationEffect::Impl {
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window = new osgViewer::GraphicsWindowEmbedded(0, 0, 1, 1);
  osg::ref_ptr<osgParticle::PrecipitationEffect> effect = new osgParticle::PrecipitationEffect;
  Precipitation kind = Precipitation::none;
  double density = 0, share = 1;

  Impl() {
    // It reports every drawable that it gives up.
    if (osg::getNotifyLevel() == osg::NOTICE) osg::setNotifyLevel(osg::WARN);
    effect->setCullingActive(false);
    effect->getQuadStateSet()->setAttribute(dropProgram(shaderText("drop_quad.vert.glsl")));
    effect->getLineStateSet()->setAttribute(dropProgram(shaderText("drop_line.vert.glsl")));
    effect->getPointStateSet()->setAttribute(dropProgram(shaderText("drop_point.vert.glsl")));
    effect->getPointStateSet()->removeTextureAttribute(0, osg::StateAttribute::POINTSPRITE);
    scatter(effect->getQuadGeometry(), 4);
    scatter(effect->getLineGeometry(), 2);
    scatter(effect->getPointGeometry(), 1);

    osg::StateSet* state = effect->getOrCreateStateSet();
    state->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
    // Drops are before and behind mountains, but never hide one another; the image's alpha stays 1.
    state->setAttributeAndModes(new osg::Depth(osg::Depth::GREATER, 0, 1, false));
    state->setAttributeAndModes(new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE));
    // The near plane belongs to the terrain. Whatever it is, drops before it are drawn: an effect cut off at
    // a near plane that moves out with the far one is what document D saw, particles that shrink and vanish
    // from the lower part of the image.
    state->setMode(GL_DEPTH_CLAMP, osg::StateAttribute::ON);
    state->setAttributeAndModes(
        new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
    for (const GLenum off : {GL_LIGHTING, GL_CULL_FACE, GL_ALPHA_TEST})
      state->setMode(off, osg::StateAttribute::OFF);

    osg::Camera* camera = viewer->getCamera();
    camera->setGraphicsContext(window);
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    camera->setCullingMode(osg::CullSettings::NO_CULLING);
    camera->setClearMask(0);
    viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    viewer->setReleaseContextAtEndOfFrameHint(false);
    viewer->setLightingMode(osg::View::NO_LIGHT);
    viewer->setKeyEventSetsDone(0);
    viewer->setSceneData(effect);
  }

  void shape(const PrecipitationView& falling) {
    if (falling.kind == kind && falling.density == density && falling.share == share) return;
    kind = falling.kind;
    density = falling.density;
    share = falling.share;
    const float intensity = static_cast<float>(density);
    if (kind == Precipitation::snow)
      effect->snow(intensity);
    else
      effect->rain(intensity);
    effect->setMaximumParticleDensity(effect->getMaximumParticleDensity() * static_cast<float>(share));
    effect->setUseFarLineSegments(kind == Precipitation::rain);
  }
};

PrecipitationEffect::PrecipitationEffect() : impl_(std::make_unique<Impl>()) {}

PrecipitationEffect::~PrecipitationEffect() {
  osg::State* state = impl_->window->getState();
  impl_->effect->releaseGLObjects(state);
  impl_->viewer->getCamera()->releaseGLObjects(state);
  // The objects are flushed while the window lives: with the last window of a context, OSG forgets the
  // context's lists.
  osg::flushAllDeletedGLObjects(state->getContextID());
}

void PrecipitationEffect::draw(const PrecipitationView& falling, const SceneView& view, unsigned fbo) {
  osgParticle::PrecipitationEffect& effect = *impl_->effect;
  impl_->shape(falling);

  const osg::Vec3 cell = effect.getCellSize();
  const PrecipitationLook& look = falling.look;
  const double speed = std::abs(double{effect.getParticleSpeed()}) * look.fallSpeed.value();
  // Cells stand still in the air, which the wind carries.
  const Vec3 inAir = view.eye.position - falling.airDrift;
  const Vec3 eye = isFinite(inAir) ? inAir : Vec3{};
  effect.setPosition(toFloat(latticeFromEye(eye, {double{cell.x()}, double{cell.y()}, double{cell.z()}})));

  // A drop draws its streak for so long, seconds, and the streak is at most this long, metres.
  constexpr double kExposureS = 1.0 / 30, kLongestStreakM = 0.8;
  Vec3 back = (isFinite(falling.velocity) ? falling.velocity : Vec3{}) + Vec3{0, 0, speed};
  back = back * std::min(kExposureS, kLongestStreakM / std::max(length(back), 1e-3));
  osg::StateSet* state = effect.getOrCreateStateSet();
  const auto set = [state](const char* name, osg::Uniform::Type type, const auto& value) {
    state->getOrCreateUniform(name, type)->set(value);
  };
  using Type = osg::Uniform::Type;
  set("phase", Type::FLOAT, fraction(falling.time * speed / double{cell.z()}));
  set("radius", Type::FLOAT, effect.getParticleSize() * 0.5f * static_cast<float>(look.size.value()));
  set("streak", Type::FLOAT_VEC3, toFloat(view.eye.axes * back));
  set("pixelsPerMetre", Type::FLOAT,
      static_cast<float>(view.shape.heightPx / (view.shape.top - view.shape.bottom)));
  set("farM", Type::FLOAT, effect.getFarTransition());
  set("extinction", Type::FLOAT, view.air.extinction);
  set("dropColour", Type::FLOAT_VEC3, toFloat({look.red.value(), look.green.value(), look.blue.value()}));

  osg::Camera* camera = impl_->viewer->getCamera();
  camera->setViewport(0, 0, view.shape.widthPx, view.shape.heightPx);
  camera->setViewMatrix(osg::Matrixd(eyeMatrix(view.eye.axes).data()));
  camera->setProjectionMatrix(osg::Matrixd(projectionMatrix(view.shape).data()));
  impl_->window->setDefaultFboId(fbo);
  settle(*impl_->window->getState());
  impl_->viewer->frame();
  settle(*impl_->window->getState());
}

}  // namespace trimtab::scene
