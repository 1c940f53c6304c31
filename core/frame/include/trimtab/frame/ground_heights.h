#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Reports the height of the terrain. A session asks for it if an aircraft is to stand on it, or if something
/// needs the height above ground: the altitude membership (fuzzy.altitude.reference), a rule of the policy,
/// or whoever watches the signals. It asks for the highest ground if the air is a layer of haze.
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Returns the height above mean sea level at a place (WGS 84, east positive, longitudes of any turn). A
  /// database interpolates it bilinearly between its four nearest posts, so that it can differ from the
  /// surface as drawn. Returns nullopt where there are no data, or where they are damaged. Several threads
  /// may call it at once; it may wait for a block from the disk.
  virtual std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const = 0;
  /// Returns a height above mean sea level that no ground exceeds; nullopt if none is known.
  virtual std::optional<Metres> highest() const { return std::nullopt; }
  /// Returns how far apart the posts are from south to north, whose heights are known. Whoever looks along
  /// the ground, or for its slope, needs no finer steps.
  virtual Metres postDistance() const { return Metres{10}; }
};

/// The slope of the ground: metres up for a metre east and a metre north.
struct GroundSlope {
  double east = 0, north = 0;
};
/// Returns the slope over one distance of posts; nullopt where the ground is not known all around. It asks
/// for four heights.
std::optional<GroundSlope> slopeAt(const GroundHeights& ground, Degrees latitude, Degrees longitude);

}  // namespace trimtab
