#pragma once

#include "trimtab/frame/frame.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::scene {

/// Knows the outline of a terrain's data and reports from where the proofs of occlusion.h and horizon.h
/// hold: whatever hides something must be ground that is drawn.
class DataExtent {
 public:
  DataExtent() = default;
  explicit DataExtent(const terrain::TerrainInfo& info);

  /// Returns how far a straight line between two places inside can bulge over the border, metres.
  double sagM() const { return sagM_; }
  double metresPerDegreeNorth() const { return metresNorth_; }
  double metresPerDegreeEast() const { return metresEast_; }  ///< the least in the extent
  /// Returns a sentence that says why nothing may be hidden from an eye at this place, local frame; empty if
  /// something may.
  const char* refusal(const LocalFrame& frame, Vec3 eye) const;

 private:
  double south_ = 0, north_ = 0, middle_ = 0, width_ = 0;  ///< degrees, the last two of longitude
  double metresNorth_ = 0, metresEast_ = 0;
  double sagM_ = 0;
};

/// Returns the width from the western border eastward to the other one. Longitudes of borders are wrapped,
/// and the date line may lie between them.
Degrees widthOf(const terrain::TerrainInfo& info);
/// Returns where the terrain's posts are.
terrain::PostGrid postsOf(const terrain::TerrainInfo& info);
/// Returns a place on the ellipsoid by fractions of the terrain's extent, from its south-western corner.
GeodeticPosition placeIn(const terrain::TerrainInfo& info, double east, double north);
bool liesOver(const terrain::TerrainInfo& info, const GeodeticPosition& place);

/// Returns the angle between the frame's z and the vertical at a place, radians.
double leanOf(Vec3 place);

/// Returns a sentence if the near plane might reach the ground; empty if it cannot. Its corners are
/// `nearestM` from the eye, which is `aboveM` over ground that is at most this steep (rise over run).
const char* nearPlaneRefusal(double aboveM, double nearestM, double slope);
/// Returns the distance of the near plane's corners from the eye, metres.
double nearestOf(const ViewShape& view);

}  // namespace trimtab::scene
