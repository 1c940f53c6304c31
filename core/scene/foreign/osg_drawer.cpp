#include "osg_drawer.h"

#include <osg/Depth>
#include <osg/Fog>
#include <osg/GLObjects>
#include <osgDB/DatabasePager>
#include <osgUtil/CullVisitor>
#include <osgUtil/SceneView>
#include <osgUtil/Statistics>
#include <osgUtil/UpdateVisitor>

#include <algorithm>
#include <cmath>
#include <thread>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/osg_state.h"
#include "page_reads.h"

namespace trimtab::scene {
namespace {

/// OSG's cull, which also leaves out what is wholly farther than a distance: our projection has no far plane.
class CullsFar final : public osgUtil::CullVisitor {
 public:
  CullsFar() = default;
  CullVisitor* clone() const override { return new CullsFar(*this); }
  void apply(osg::LOD& node) override {
    if (!isFar(node.getBound())) CullVisitor::apply(node);
  }
  void apply(osg::Drawable& drawable) override {
    if (!isFar(drawable.getBound())) CullVisitor::apply(drawable);
  }
  double farM = 0;

 private:
  bool isFar(const osg::BoundingSphere& bound) const {
    return std::isfinite(farM) && bound.valid() &&
           (osg::Vec3d(getEyeLocal()) - osg::Vec3d(bound.center())).length() - double{bound.radius()} > farM;
  }
};

/// Returns OSG's LOD scale. An allowed error above the preset's is the same factor on it; full quality is the
/// scene as its author made it, and nothing asks for more.
double lodScaleOf(const FrameRequest& r) {
  const double byError = r.levers.drawn.errorPx / r.levers.preset.errorPx;
  return r.levers.drawn.lodScale * (byError > 1 ? byError : 1);
}

}  // namespace

struct OsgDrawer::Scene {
  osg::ref_ptr<PageReads> reads;
  osg::ref_ptr<osg::Node> root;
  osg::ref_ptr<osgUtil::SceneView> view = new osgUtil::SceneView;
  osg::ref_ptr<osgDB::DatabasePager> pager = osgDB::DatabasePager::create();
  osg::ref_ptr<osgUtil::UpdateVisitor> update = new osgUtil::UpdateVisitor;
  osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
  osg::ref_ptr<CullsFar> cull = new CullsFar;
  osg::ref_ptr<osg::Fog> fog = new osg::Fog;

  explicit Scene(const std::filesystem::path& file) : reads(new PageReads(file)), root(reads->readRoot()) {
    view->setDefaults(osgUtil::SceneView::STANDARD_SETTINGS);
    view->getState()->setContextID(osg::GraphicsContext::createNewContextID());
    view->setCullVisitor(cull);
    view->setFrameStamp(stamp);
    update->setFrameStamp(stamp);
    update->setDatabaseRequestHandler(pager);
    cull->setDatabaseRequestHandler(pager);
    view->setUpdateVisitor(update);
    view->setSceneData(root);
    view->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    osg::Camera* camera = view->getCamera();
    camera->setClearMask(0);
    camera->setDrawBuffer(GL_COLOR_ATTACHMENT0);
    camera->setReadBuffer(GL_COLOR_ATTACHMENT0);
    osg::StateSet* state = view->getGlobalStateSet();
    state->setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL),
                                osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    fog->setMode(osg::Fog::EXP);
    state->setAttribute(fog);
    // Nothing compiles ahead in another context: what was read is compiled when it is first drawn.
    pager->setDoPreCompile(false);
  }
  ~Scene() {
    pager->cancel();
    if (root) root->releaseGLObjects(view->getState());
    view->releaseAllGLObjects();
    osg::flushAllDeletedGLObjects(view->getState()->getContextID());
    osg::GraphicsContext::decrementContextIDUsageCount(view->getState()->getContextID());
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void cullOnce(double time) {
    stamp->setFrameNumber(stamp->getFrameNumber() + 1);
    stamp->setReferenceTime(time);
    stamp->setSimulationTime(time);
    pager->signalBeginFrame(stamp);
    pager->updateSceneGraph(*stamp);
    view->update();
    view->cull();
    pager->signalEndFrame();
  }
  /// Culls until a cull asked for no page that can be read. A page that cannot is asked for in every cull.
  void cullWithPages(double time) {
    for (std::uint64_t before = 0;; before = reads->count()) {
      cullOnce(time);
      const bool merged = before == reads->count();
      while (pager->getFileRequestListSize() > 0 ||
             (pager->getRequestsInProgress() && !pager->requiresUpdateSceneGraph()))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (merged && before == reads->count() && !pager->requiresUpdateSceneGraph()) return;
    }
  }
};

OsgDrawer::OsgDrawer() = default;
OsgDrawer::~OsgDrawer() = default;

void OsgDrawer::setTerrain(std::shared_ptr<const terrain::Database> database) {
  scene_.reset();
  database_ = std::dynamic_pointer_cast<const OsgDatabase>(std::move(database));
  visible_ = {};
}

Findings OsgDrawer::failures() const {
  return scene_ ? scene_->reads->findings() : Findings{};
}

void OsgDrawer::release() {
  scene_.reset();
}

PreparedTerrain OsgDrawer::prepare(const FrameInProgress& frame) {
  begin(frame);
  const FrameRequest& r = frame.request;
  if (!scene_) scene_ = std::make_unique<Scene>(database_->file());
  Scene& scene = *scene_;
  osgUtil::SceneView& view = *scene.view;
  view.setViewport(0, 0, frame.shape.widthPx, frame.shape.heightPx);
  view.setProjectionMatrix(osg::Matrixd(projectionMatrix(frame.shape).data()));
  // The axes of the eye are those of the terrain's frame; geocentric scenes are turned into it.
  const LocalFrame& local = database_->index().frame;
  const Mat3 axes = database_->geocentric() ? frame.eye.axes * local.ecefToLocal() : frame.eye.axes;
  const Vec3 eye = database_->geocentric() ? local.toEcef(frame.eye.position) : frame.eye.position;
  view.setViewMatrix(osg::Matrixd::translate(-eye.x, -eye.y, -eye.z) * osg::Matrixd(eyeMatrix(axes).data()));
  const FrameLevers& levers = r.levers.drawn;
  view.setLODScale(static_cast<float>(lodScaleOf(r)));
  view.setSmallFeatureCullingPixelSize(static_cast<float>(levers.smallFeaturePx));
  scene.cull->farM = farCutM(r);
  if (r.waitForPages)
    scene.cullWithPages(r.time);
  else
    scene.cullOnce(r.time);
  frame.clock.lap(&FrameCost::select);

  osgUtil::Statistics counted;
  view.getStats(counted);
  visible_.triangles = 0;
  for (const auto& [mode, primitives] : counted.getPrimitiveCountMap())
    if (mode >= GL_TRIANGLES) visible_.triangles += std::uint64_t{primitives} * (mode == GL_QUADS ? 2 : 1);
  visible_.vertices = static_cast<std::uint64_t>(counted._vertexCount);

  PreparedTerrain prepared;
  prepared.occlusion.note = "Hidden ground is not looked for in a scene of OpenSceneGraph.";
  prepared.paging.waiting = scene.pager->getFileRequestListSize();
  prepared.paging.pagesRead = scene.reads->count();
  prepared.paging.failed = scene.reads->failed();
  prepared.paging.settled = !scene.pager->getRequestsInProgress();
  return prepared;
}

void OsgDrawer::drawScene(const Air& air) {
  osgUtil::SceneView& view = *scene_->view;
  osg::StateSet* global = view.getGlobalStateSet();
  global->setMode(GL_FOG, air.clear ? osg::StateAttribute::OFF : osg::StateAttribute::ON);
  scene_->fog->setDensity(air.extinction);
  scene_->fog->setColor({air.colour[0], air.colour[1], air.colour[2], 1});
  GLint frame = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &frame);
  const osg::Viewport& image = *view.getViewport();
  glUseProgram(0);
  settle(*view.getState());
  view.draw();
  settle(*view.getState());
  view.getState()->disableAllVertexArrays();
  // OSG leaves a viewport of 800 x 600, not the image's.
  glViewport(0, 0, static_cast<GLsizei>(image.width()), static_cast<GLsizei>(image.height()));
  glDisable(GL_FOG);
  view.getState()->haveAppliedMode(GL_FOG, false);
  glActiveTexture(GL_TEXTURE0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(frame));
  double seconds = 0.001;  // for what paging removed, so that a frame pays little for it
  view.flushDeletedGLObjects(seconds);
}

}  // namespace trimtab::scene
