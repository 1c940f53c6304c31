#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "core/scene/passes/weather_air.h"
#include "core/scene/passes/weather_precipitation.h"
#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// What the graph calls back to, in the order of a frame; raw GL is allowed inside. Each gets the program in
/// use.
struct ScenePasses {
  using Call = std::function<void(unsigned program)>;
  Call begin;      ///< OSG's cull is done, nothing is drawn yet
  Call occluders;  ///< into the depth map
  Call reduce;     ///< the depth map's pyramid
  Call test;       ///< tiles against the depth map; afterwards the visible set stands
  // Of the form that the view names, with its shaders.
  Call surface;
  Call wire;                         ///< the same again as lines
  Call numbers;                      ///< the same again, for which node each pixel shows
  Call treePicture;                  ///< document E's picture of static trees
  Call lines;                        ///< overlay lines
  Call beforeWeather, afterWeather;  ///< around what falls, where something does
};

/// The depth map's side of a frame.
struct DepthView {
  EyePose eye;  ///< the main view's, or the frozen one
  int widthPx = 0, heightPx = 0;
  int levels = 0, tiles = 0;
  double loweringScale = 1;  ///< less than 1 is wrong: for the test that sees the picture break
  int shiftTexels = 0;       ///< not 0 is wrong likewise: where the map is read
};

/// A frame's view as the graph's uniforms and matrices need it.
struct SceneView {
  EyePose eye;
  Vec3 up{0, 0, 1};       ///< local vertical at the eye
  double horizonDip = 0;  ///< radians
  ViewShape shape;
  int guardBand = 1;  ///< guard_band.h
  std::optional<DepthView> depth;
  /// An eye over the ground and above it never sees its underside: triangles that face away are dropped,
  /// which saves a third of the frame. In every culling case, since guard_band.h says what it may change.
  bool oneSided = false;
  bool sky = true, tinted = false, wireframe = false, lines = false;
  std::optional<TerrainForm> form;  ///< of the terrain that is drawn; none: no terrain
  bool treePicture = false;         ///< instead of the trees' surface
  /// The node pass instead of a picture: nothing but terrain, as numbers; the framebuffer's colour was
  /// cleared by whoever made it.
  bool nodes = false;
  Air air;
  double heightM = 0;  ///< of the eye above mean sea level
  std::optional<PrecipitationView> precipitation;
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
  void setAir(const SceneView& view);

  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

}  // namespace trimtab::scene
