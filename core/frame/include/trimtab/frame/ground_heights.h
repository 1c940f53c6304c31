#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Reports the height of the terrain. A session asks for it if the preset derives the altitude membership
/// from the height above ground (fuzzy.altitude.reference) and the host does not send that height, and for
/// the highest ground if the air is a layer of haze.
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Returns the height above mean sea level at a place (WGS 84, east positive, longitudes of any turn). It
  /// is interpolated bilinearly between the nearest samples of the most detailed surface. Returns nullopt
  /// where there are no data. Several threads may call it at once; it may wait for a block from the disk.
  virtual std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const = 0;
  /// Returns a height above mean sea level that no ground exceeds; nullopt if none is known.
  virtual std::optional<Metres> highest() const { return std::nullopt; }
};

}  // namespace trimtab
