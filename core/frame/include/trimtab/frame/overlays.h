#pragma once

/// What an image shows for the engineer, not for the pilot.
namespace trimtab {

/// What of the picture is for the engineer, not for the pilot.
struct Overlays {
  bool wireframe = false, tileBounds = false, colourByLevel = false;
  bool colourByReason =
      false;  ///< draws what was culled too, so that it can be seen (with `frozenEye` above all)
  /// One level of the static trees whatever the distance, 0 at the roots; -1: by distance.
  int treeDepth = -1;
  bool treePicture = false;  ///< document E's: faces light grey, edges red, locked edges black
  bool voids = false;        ///< what was filled stands out, where patches are drawn
  bool showHoles = false;    ///< no sky: magenta wherever no terrain is drawn
  friend bool operator==(const Overlays&, const Overlays&) = default;
};

}  // namespace trimtab
