#pragma once

#include <span>
#include <string>
#include <vector>

#include "log_columns.h"

namespace trimtab {

/// Columns of angles that name no unit, row by row.
struct UnnamedAngles {
  std::vector<std::string> names;       ///< of the columns
  std::vector<std::string> quantities;  ///< as a map has them, without a unit: "roll", "head_pitch"
  std::vector<std::vector<double>> columns;
  /// Columns of which one is a pitch, which lies within a quarter turn.
  std::vector<std::size_t> maybePitch;
};

/// Finds whether angles are degrees or radians, and appends a note. If both fit, appends an error that says
/// so and returns Unit::none.
Unit angleUnit(const UnnamedAngles& angles, const std::string& where, Findings& findings);

}  // namespace trimtab
