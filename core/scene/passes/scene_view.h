#pragma once

#include <array>
#include <optional>

#include "trimtab/culling/select.h"
#include "trimtab/preset/parameters.h"
#include "weather_air.h"
#include "weather_precipitation.h"

namespace trimtab::scene {

/// The view of the depth map that GL draws.
struct DepthView {
  EyePose eye;  ///< the main view's, or the frozen one
  int widthPx = 0, heightPx = 0;
  int levels = 0, tiles = 0;
  double loweringScale = 1;  ///< less than 1 is wrong; tests see the image break
  int shiftTexels = 0;       ///< not 0 is wrong likewise
};

/// A frame's view as the passes need it.
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
  Air air;
  double heightM = 0;  ///< of the eye above mean sea level
  std::optional<PrecipitationView> precipitation;
};

/// Returns the matrix of an eye at the origin, in GL's order: column by column.
inline std::array<double, 16> eyeMatrix(const Mat3& axes) {
  const auto& [right, up, back] = axes.row;
  return {right.x, up.x, back.x, 0, right.y, up.y, back.y, 0, right.z, up.z, back.z, 0, 0, 0, 0, 1};
}
/// Returns the matrix of a perspective likewise. Depth is near / distance: 1 at the near plane and 0 at
/// infinity, with clip control from zero to one.
inline std::array<double, 16> projectionMatrix(const ViewShape& v) {
  const double width = v.right - v.left, height = v.top - v.bottom;
  return {
      2 / width, 0,  0, 0, 0,       2 / height, 0, 0, (v.right + v.left) / width, (v.top + v.bottom) / height,
      0,         -1, 0, 0, v.nearM, 0};
}

}  // namespace trimtab::scene
