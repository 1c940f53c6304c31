#pragma once

#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Answers how high the ground is, for decisions by height above ground where the host does not send that
/// height.
class GroundHeights {
 public:
  virtual ~GroundHeights() = default;
  /// Height of the finest surface (bilinear between posts); none outside the data. Thread-safe.
  virtual std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const = 0;
};

}  // namespace trimtab
