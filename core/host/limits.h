#pragma once

#include <algorithm>

/// Bounds what a packet or a row may say of an aircraft before it is refused.
namespace trimtab::limits {

/// A float's rounding of 90 or 180 degrees from radians lies just outside; it is meant as the limit itself.
inline constexpr double kSlack = 1e-4;
inline constexpr double kLatitude = 90 + kSlack;
inline constexpr double kPitch = 90 + kSlack;
inline constexpr double kTurn =
    360 + kSlack;  ///< headings, rolls and longitudes: hosts write -180..180 and 0..360
inline constexpr double kLowest = -20000, kHighest = 1e6;  ///< metres
inline constexpr double kVisibility = 1e7;                 ///< metres
/// An aircraft below this height (-1,000 ft) means that the simulator is not ready yet: FlightGear starts at
/// -9,999 ft.
inline constexpr double kReady = -304.8;

inline double clampedLatitude(double degrees) {
  return std::clamp(degrees, -90.0, 90.0);
}
inline double clampedPitch(double degrees) {
  return std::clamp(degrees, -90.0, 90.0);
}

}  // namespace trimtab::limits
