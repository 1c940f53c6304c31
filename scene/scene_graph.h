#pragma once

#include <array>
#include <functional>
#include <memory>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// What the graph calls back to, in the order of a frame; raw GL is allowed inside.
struct ScenePasses {
  std::function<void()> begin;    ///< OSG's cull is done, nothing is drawn yet
  std::function<void()> terrain;  ///< the one multi-draw; the terrain program is in use
  std::function<void()> wire;     ///< the same again as lines
  std::function<void()> lines;    ///< overlay lines
};

/// A frame's view as the graph's uniforms and matrices need it.
struct SceneView {
  EyePose eye;
  Vec3 up{0, 0, 1};       ///< local vertical at the eye
  double horizonDip = 0;  ///< radians
  ViewShape shape;
  bool sky = true, tinted = false, wireframe = false, lines = false;
};

/// The OSG side of the renderer: viewer, cameras, state and shaders. Drawing itself is in the passes.
class SceneGraph {
 public:
  explicit SceneGraph(ScenePasses passes);
  /// The context is current: frees OSG's GL objects.
  ~SceneGraph();
  SceneGraph(const SceneGraph&) = delete;
  SceneGraph& operator=(const SceneGraph&) = delete;

  /// One frame into the framebuffer that is bound, which is `fbo`.
  void frame(const SceneView& view, unsigned fbo);

 private:
  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace trimtab::scene
