#include "culling_peers.h"

// Before OSG, which includes GL without prototypes.
#include "core/scene/gl/gl_api.h"

#include <osg/Geometry>
#include <osgViewer/GraphicsWindow>
#include <osgViewer/Viewer>

#include <algorithm>
#include <functional>

#include "osg_cull.h"

namespace trimtab::bench {
namespace {

osg::ref_ptr<osg::Node> quadtree(const TerrainIndex& index, std::uint32_t node) {
  if (index.level[node] == 0) return new BoundOnly(index.bounds[node], node);
  osg::ref_ptr<osg::Group> group = new osg::Group;
  for (const std::uint32_t child : index.children[node])
    if (child != TerrainIndex::kNone) group->addChild(quadtree(index, child));
  return group;
}

/// Draws all tiles as the terrain's layers do.
class AllTiles final : public osg::Drawable {
 public:
  AllTiles() = default;
  AllTiles(const AllTiles& other, const osg::CopyOp& op) : osg::Drawable(other, op) {}
  AllTiles(const std::vector<osg::Vec3f>& vertices, const Submission& submission)
      : anew_(submission.anew), draw_(std::make_unique<scene::MultiDraw>(*submission.way)) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
    setCullingActive(false);
    for (std::uint32_t i = 0; 3 * i < vertices.size(); ++i) tiles_.push_back({.node = i});
    const std::uint16_t indices[3] = {0, 1, 2};
    glGenVertexArrays(1, &array_);
    glBindVertexArray(array_);
    GLuint buffers[2];
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof vertices[0]),
                 vertices.data(), GL_STATIC_DRAW);
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
  }
  META_Object(trimtab, AllTiles);
  void drawImplementation(osg::RenderInfo&) const override {
    places_ += anew_;
    if (draw_->begin(tiles_, places_))
      for (const TileDraw& tile : tiles_) draw_->add(0, 3, 3 * tile.node);
    draw_->draw(array_, GL_UNSIGNED_SHORT);
  }

 private:
  std::vector<TileDraw> tiles_;
  bool anew_ = false;
  mutable std::uint64_t places_ = 1;
  std::unique_ptr<scene::MultiDraw> draw_;
  GLuint array_ = 0;
};

}  // namespace

struct OsgBoxTests::Impl {
  Impl(const EyePose& eye, const ViewShape& view) : pushed(stack, viewport, eye, view) {
    polytope.setToUnitFrustum();
    polytope.transformProvidingInverse(viewOf(eye) * projectionOf(view, ViewOf::kCullFar));
  }
  osg::CullStack stack;
  osg::ref_ptr<osg::Viewport> viewport = new osg::Viewport(0, 0, 1280, 720);
  ViewOf pushed;
  osg::Polytope polytope;
};

OsgBoxTests::OsgBoxTests(const EyePose& eye, const ViewShape& view)
    : impl_(std::make_unique<Impl>(eye, view)) {}
OsgBoxTests::~OsgBoxTests() = default;

std::size_t OsgBoxTests::cullingSet(std::span<const Box> boxes) {
  osg::CullingSet& set = impl_->stack.getCurrentCullingSet();
  std::size_t kept = 0;
  for (const Box& box : boxes) kept += !set.isCulled(boundOf(box));
  return kept;
}

std::size_t OsgBoxTests::polytope(std::span<const Box> boxes) {
  std::size_t kept = 0;
  for (const Box& box : boxes) {
    impl_->polytope.setupMask();
    kept += impl_->polytope.contains(boundOf(box));
  }
  return kept;
}

struct OsgQuadtree::Impl {
  osg::ref_ptr<osg::Group> root = new osg::Group;
  CullTraversal traversal;
};

OsgQuadtree::OsgQuadtree(const TerrainIndex& index) : impl_(std::make_unique<Impl>()) {
  for (std::uint32_t node = 0; node < index.size(); ++node)
    if (index.parent[node] == TerrainIndex::kNone) impl_->root->addChild(quadtree(index, node));
  impl_->root->getBound();
}
OsgQuadtree::~OsgQuadtree() = default;

std::size_t OsgQuadtree::cull(const EyePose& eye, const ViewShape& view) {
  return impl_->traversal.cull(*impl_->root, eye, view);
}

std::vector<std::uint32_t> OsgQuadtree::kept() const {
  std::vector<std::uint32_t> nodes;
  for (const auto& leaf : impl_->traversal.kept())
    nodes.push_back(static_cast<const BoundOnly*>(leaf->getDrawable())->node());
  return nodes;
}

double submitMilliseconds(int tiles, Submission submission, unsigned framebuffer, int frames) {
  osgViewer::Viewer viewer;
  viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
  osg::ref_ptr<osgViewer::GraphicsWindowEmbedded> window =
      new osgViewer::GraphicsWindowEmbedded(0, 0, 640, 360);
  window->setDefaultFboId(framebuffer);
  osg::Camera* camera = viewer.getCamera();
  camera->setGraphicsContext(window);
  camera->setViewport(0, 0, 640, 360);
  camera->setProjectionMatrix(osg::Matrixd::ortho(-1, 1, -1, 1, -1, 1));
  camera->setViewMatrix(osg::Matrixd::identity());
  camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
  camera->setCullingMode(osg::CullSettings::NO_CULLING);
  osg::ref_ptr<osg::Group> root = new osg::Group;
  root->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
  std::vector<osg::Vec3f> all;
  for (int i = 0; i < tiles; ++i) {
    const float x = static_cast<float>(i % 64) / 32 - 1, y = static_cast<float>(i / 64 % 64) / 32 - 1;
    const std::vector<osg::Vec3f> triangle{{x, y, 0}, {x + 0.02f, y, 0}, {x, y + 0.02f, 0}};
    all.insert(all.end(), triangle.begin(), triangle.end());
    if (submission.way) continue;
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setUseDisplayList(false);
    geometry->setUseVertexBufferObjects(true);
    geometry->setVertexArray(new osg::Vec3Array(triangle.begin(), triangle.end()));
    const GLushort indices[3] = {0, 1, 2};
    geometry->addPrimitiveSet(new osg::DrawElementsUShort(GL_TRIANGLES, 3, indices));
    root->addChild(geometry);
  }
  if (submission.way) root->addChild(new AllTiles(all, submission));
  viewer.setSceneData(root);
  viewer.realize();
  camera->getStats()->collectStats("rendering", true);
  double least = 1e9;
  for (int i = 0; i < frames + 3; ++i) {
    viewer.frame();
    glFinish();
    double seconds = 0;
    const unsigned number = viewer.getFrameStamp()->getFrameNumber();
    if (i >= 3 && camera->getStats()->getAttribute(number, "Draw traversal time taken", seconds))
      least = std::min(least, 1e3 * seconds);
  }
  return least;
}

}  // namespace trimtab::bench
