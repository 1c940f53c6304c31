#pragma once

#include <osg/Drawable>
#include <osg/Group>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <cstdint>

#include "osg_view.h"

/// OpenSceneGraph's cull traversal of tiles that are nothing but their bounds.
namespace trimtab::bench {

class BoundOnly final : public osg::Drawable {
 public:
  BoundOnly() = default;
  BoundOnly(const BoundOnly& other, const osg::CopyOp& op)
      : osg::Drawable(other, op), box_(other.box_), node_(other.node_) {}
  BoundOnly(const Box& box, std::uint32_t node) : box_(boundOf(box)), node_(node) {
    setUseDisplayList(false);
    setSupportsDisplayList(false);
  }
  META_Object(trimtab, BoundOnly);
  osg::BoundingBox computeBoundingBox() const override { return box_; }
  void drawImplementation(osg::RenderInfo&) const override {}
  std::uint32_t node() const { return node_; }

 private:
  osg::BoundingBox box_;
  std::uint32_t node_ = 0;
};

/// A view as OSG culls by it, for as long as this lives.
class ViewOf {
 public:
  ViewOf(osg::CullStack& stack, osg::Viewport* viewport, const EyePose& eye, const ViewShape& view)
      : stack_(stack) {
    stack.setCullingMode(osg::CullSettings::VIEW_FRUSTUM_CULLING);
    stack.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
    stack.pushViewport(viewport);
    stack.pushProjectionMatrix(new osg::RefMatrix(projectionOf(view, kCullFar)));
    stack.pushModelViewMatrix(new osg::RefMatrix(viewOf(eye)), osg::Transform::ABSOLUTE_RF);
  }
  ~ViewOf() {
    stack_.popModelViewMatrix();
    stack_.popProjectionMatrix();
    stack_.popViewport();
  }
  ViewOf(const ViewOf&) = delete;
  ViewOf& operator=(const ViewOf&) = delete;

  static constexpr double kCullFar = 1e7;

 private:
  osg::CullStack& stack_;
};

class CullTraversal {
 public:
  /// How many drawables are kept.
  std::size_t cull(osg::Node& root, const EyePose& eye, const ViewShape& view) {
    visitor_->reset();
    graph_->clean();
    stage_->reset();
    visitor_->setStateGraph(graph_);
    visitor_->setRenderStage(stage_);
    const ViewOf pushed(*visitor_, viewport_, eye, view);
    root.accept(*visitor_);
    return kept().size();
  }
  /// Of the last traversal.
  const osgUtil::StateGraph::LeafList& kept() const { return graph_->_leaves; }

 private:
  osg::ref_ptr<osgUtil::CullVisitor> visitor_ = new osgUtil::CullVisitor;
  osg::ref_ptr<osgUtil::StateGraph> graph_ = new osgUtil::StateGraph;
  osg::ref_ptr<osgUtil::RenderStage> stage_ = new osgUtil::RenderStage;
  osg::ref_ptr<osg::Viewport> viewport_ = new osg::Viewport(0, 0, 1280, 720);
};

}  // namespace trimtab::bench
