#pragma once

#include <limits>

namespace trimtab {

/// Not a number. It stands for a value that is unknown or was not measured.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Infinity. It stands for a limit that does not exist.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace trimtab
