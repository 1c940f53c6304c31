#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Reports the height of the ground. A session asks it if the preset decides by height above ground and the
/// host does not send that height.
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Returns the height of the finest surface above mean sea level, bilinear between posts; nothing outside
  /// the data. May be called from any thread.
  virtual std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const = 0;
};

}  // namespace trimtab
