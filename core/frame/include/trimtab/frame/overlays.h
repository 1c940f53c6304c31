#pragma once

/// Declares what an image shows for the engineer, not for the pilot.
namespace trimtab {

/// Overlays of one image.
struct Overlays {
  bool wireframe = false, tileBounds = false, colourByLevel = false;
  bool colourByReason = false;  ///< also draws culled nodes; most useful with `frozenEye`
  /// Draws this depth of the static trees at any distance, 0 is the roots; -1 selects by distance.
  int treeDepth = -1;
  bool treePicture = false;  ///< document E's image: faces light grey, edges red, locked edges black
  /// Lays squares of an eighth of a texture over static trees that kept their texture coordinates.
  bool textureSquares = false;
  bool voids = false;      ///< highlights filled voids, if patches are drawn
  bool showHoles = false;  ///< draws no sky: pixels without terrain stay magenta
  friend bool operator==(const Overlays&, const Overlays&) = default;
};

}  // namespace trimtab
