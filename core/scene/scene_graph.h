#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/scene/passes/weather_air.h"
#include "core/scene/passes/weather_precipitation.h"
#include "trimtab/culling/select.h"

namespace osg {
class Vec3f;
}

namespace trimtab::scene {

osg::Vec3f toFloat(Vec3 v);

/// Names what the graph calls, in the order of a frame; raw GL is allowed inside. Each call gets the program
/// in use.
struct ScenePasses {
  using Call = std::function<void(unsigned program)>;
  Call begin;      ///< OSG's cull is done and nothing is drawn yet
  Call occluders;  ///< draws into the depth map
  Call reduce;     ///< builds the depth map's pyramid
  Call test;       ///< tests tiles against the depth map; completes the visible set
  // These draw the form of the terrain that the view names, with its shaders.
  Call surface;
  Call wire;                         ///< the same again as lines
  Call numbers;                      ///< the same again, as the number of the node
  Call treePicture;                  ///< document E's image of static trees
  Call lines;                        ///< overlay lines
  Call beforeWeather, afterWeather;  ///< around precipitation, if there is any
};

/// The view of the depth map that GL draws.
struct DepthView {
  EyePose eye;  ///< the main view's, or the frozen one
  int widthPx = 0, heightPx = 0;
  int levels = 0, tiles = 0;
  double loweringScale = 1;  ///< less than 1 is wrong; tests see the image break
  int shiftTexels = 0;       ///< not 0 is wrong likewise
};

/// A frame's view as the graph's uniforms and matrices need it.
struct SceneView {
  EyePose eye;
  Vec3 up{0, 0, 1};       ///< local vertical at the eye
  double horizonDip = 0;  ///< radians
  ViewShape shape;
  int guardBand = 1;  ///< guard_band.h
  std::optional<DepthView> depth;
  /// Drops triangles that face away, which saves a third of the frame, because an eye above the ground never
  /// sees its underside. This holds in every culling case; guard_band.h says what it may change.
  bool oneSided = false;
  /// FrameRequest::exactSlivers on a software rasteriser: the steps of its grid per pixel; else 0.
  int gridStepsPerPixel = 0;
  bool sky = true, tinted = false, wireframe = false, lines = false;
  std::optional<TerrainForm> form;  ///< of the terrain that is drawn; unset without terrain
  bool groundTexture = false;       ///< the terrain has colours of the ground, which patches show
  bool treePicture = false;         ///< drawn instead of the trees' surface
  bool textureSquares = false;      ///< Overlays::textureSquares
  /// Draws the node pass instead of an image: terrain as numbers, and nothing else. The caller has cleared
  /// the framebuffer's colour.
  bool nodes = false;
  Air air;
  double heightM = 0;  ///< of the eye above mean sea level
  std::optional<PrecipitationView> precipitation;
};

/// The OSG side of the renderer: viewer, cameras, state and shaders. The passes do the drawing.
class SceneGraph {
 public:
  explicit SceneGraph(ScenePasses passes);
  /// Frees OSG's GL objects; the context must be current.
  ~SceneGraph();
  SceneGraph(const SceneGraph&) = delete;
  SceneGraph& operator=(const SceneGraph&) = delete;

  /// Draws one frame into the framebuffer that is bound, which is `fbo`.
  void frame(const SceneView& view, unsigned fbo);

 private:
  void setAir(const SceneView& view);

  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace trimtab::scene
