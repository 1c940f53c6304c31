#pragma once

#include "trimtab/frame/frame.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::scene {

/// The outline of a terrain's data seen from a place, and where an eye has to be for the proofs of
/// occlusion.h and horizon.h: everything that hides something must be ground that is drawn.
class DataExtent {
 public:
  DataExtent() = default;
  explicit DataExtent(const terrain::TerrainInfo& info);

  /// How far a straight line between two places inside can bulge over the border, metres.
  double sagM() const { return sagM_; }
  double metresPerDegreeNorth() const { return metresNorth_; }
  double metresPerDegreeEast() const { return metresEast_; }  ///< where it is least
  /// Why nothing may be hidden from an eye at this place, a sentence; empty when it may.
  const char* refusal(const LocalFrame& frame, Vec3 eye) const;

 private:
  double south_ = 0, north_ = 0, middle_ = 0, width_ = 0;  ///< degrees, the last two of longitude
  double metresNorth_ = 0, metresEast_ = 0;
  double sagM_ = 0;
};

/// From the western border eastward to the other one: longitudes of borders are wrapped, and the date line
/// may lie between them.
Degrees widthOf(const terrain::TerrainInfo& info);
/// Where its posts are, from what is told of it.
terrain::PostGrid postsOf(const terrain::TerrainInfo& info);
/// A place on the ellipsoid by fractions of the terrain's extent, from its south-western corner.
GeodeticPosition placeIn(const terrain::TerrainInfo& info, double east, double north);
bool liesOver(const terrain::TerrainInfo& info, const GeodeticPosition& place);

/// Lean of the frame's z from the vertical at a place, radians.
double leanOf(Vec3 place);

/// The near plane must not reach the ground anywhere: its corners are `nearestM` from the eye, which is
/// `aboveM` over ground of at most this slope. Empty when it does not.
const char* nearPlaneRefusal(double aboveM, double nearestM, double slope);
/// Distance of the near plane's corners.
double nearestOf(const ViewShape& view);

}  // namespace trimtab::scene
