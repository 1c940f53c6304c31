#pragma once

#include <limits>

namespace trimtab {

/// What is not known or not measured.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// What has no limit.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace trimtab
