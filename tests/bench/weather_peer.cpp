#include "weather_peer.h"

#include <osg/GLObjects>
#include <osgParticle/PrecipitationEffect>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include "row.h"
#include "trimtab/scene/offscreen.h"

#include <GL/gl.h>

namespace trimtab::bench {

struct OsgPrecipitation::Impl {
  std::unique_ptr<scene::Offscreen> offscreen;
  osg::ref_ptr<osgViewer::Viewer> viewer = new osgViewer::Viewer;
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window;
  osg::ref_ptr<osgParticle::PrecipitationEffect> effect = new osgParticle::PrecipitationEffect;
  Precipitation kind = Precipitation::none;
  double density = 0;
  int width = 0, height = 0;
};

OsgPrecipitation::OsgPrecipitation(int widthPx, int heightPx) : impl_(std::make_unique<Impl>()) {
  auto created = scene::Offscreen::create(widthPx, heightPx);
  if (!created) return;
  Impl& p = *impl_;
  p.width = widthPx, p.height = heightPx;
  p.offscreen = std::move(created).value();
  p.window = new osgViewer::GraphicsWindowEmbedded(0, 0, widthPx, heightPx);
  osg::Camera* camera = p.viewer->getCamera();
  camera->setGraphicsContext(p.window);
  camera->setViewport(0, 0, widthPx, heightPx);
  camera->setProjectionResizePolicy(osg::Camera::FIXED);
  camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
  // The same view as ours: 60 degrees across, level.
  const double right = 0.57735, top = right * heightPx / widthPx;
  camera->setProjectionMatrixAsFrustum(-right, right, -top, top, 1, 10000);
  camera->setViewMatrixAsLookAt({0, 0, 600}, {0, 100, 600}, {0, 0, 1});
  camera->setClearColor({0.74f, 0.80f, 0.86f, 1});
  p.viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
  p.viewer->setReleaseContextAtEndOfFrameHint(false);
  p.viewer->setLightingMode(osg::View::NO_LIGHT);
  osg::ref_ptr<osg::Group> root = new osg::Group;
  root->addChild(p.effect);
  p.viewer->setSceneData(root);
  p.window->setDefaultFboId(p.offscreen->framebuffer());
}

OsgPrecipitation::~OsgPrecipitation() {
  if (!ready()) return;
  impl_->offscreen->makeCurrent();
  impl_->effect->releaseGLObjects(impl_->window->getState());
  osg::flushAllDeletedGLObjects(impl_->window->getState()->getContextID());
}

bool OsgPrecipitation::ready() const {
  return impl_->offscreen != nullptr;
}

double OsgPrecipitation::ms(Precipitation kind, double density, double time) {
  Impl& p = *impl_;
  p.offscreen->makeCurrent();
  p.effect->setNodeMask(density > 0 ? ~0u : 0u);
  if (density > 0 && (p.kind != kind || p.density != density)) {
    const float intensity = static_cast<float>(density);
    if (kind == Precipitation::snow)
      p.effect->snow(intensity);
    else
      p.effect->rain(intensity);
    p.kind = kind;
    p.density = density;
  }
  const double start = monotonicSeconds();
  p.viewer->frame(time);
  glFinish();
  return 1e3 * (monotonicSeconds() - start);
}

double OsgPrecipitation::wetShare() {
  Impl& p = *impl_;
  std::vector<unsigned char> pixels(static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height) *
                                    4);
  glReadPixels(0, 0, p.width, p.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  std::size_t wet = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 4)
    wet += !std::equal(pixels.begin(), pixels.begin() + 3, pixels.begin() + static_cast<std::ptrdiff_t>(i));
  return static_cast<double>(wet) / static_cast<double>(pixels.size() / 4);
}

}  // namespace trimtab::bench
