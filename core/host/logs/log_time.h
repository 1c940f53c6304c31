#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "log_columns.h"
#include "trimtab/units/result.h"

/// The times of recorded rows: what a cell says, and the unit that it is in.
namespace trimtab {

inline constexpr double kDayS = 86400;
/// A larger time in any unit is damage: dates in nanoseconds since 1970 stay below it.
inline constexpr double kLargestTime = 1e19;

/// Reads a clock: an ISO 8601 date with a time, in seconds since 1970, or hours, minutes and seconds with
/// colons, in seconds since midnight. Returns nothing for any other text.
std::optional<double> readClock(std::string_view cell);

/// Returns the seconds of a named unit of time; 1 for any other.
double secondsOf(Unit unit);

/// What a clock that begins again at midnight adds to a time that follows `last`: a day if the time is then
/// at most ten minutes later, else nothing.
double dayAfter(double last, double time);

/// What bounds the steps between rows of a kind of log, and how fast what it records moves.
struct LogMotion {
  double shortestStepS, longestStepS;
  double slowest;  ///< by the slower reading, nothing moves; 0 if it may rest
  double fastest;
};

/// What a column of times is, and how it was found.
struct TimeColumn {
  std::string name;
  Unit unit = Unit::none;  ///< as the header names it
  bool clock = false;      ///< cells were read by `readClock`
};

struct TimeReading {
  double scale = 1;        ///< seconds of one
  bool fromFirst = false;  ///< whether times count from the first row: they are dates
  Findings findings;       ///< notes, or why there is none
};

/// Finds the unit of rising times, and refuses if two fit. `moved` holds how far things moved from each row
/// to the next: by the right unit they move as `motion` says.
TimeReading timeReading(const TimeColumn& column, std::span<const double> times,
                        std::span<const double> moved, const LogMotion& motion, const std::string& where);

}  // namespace trimtab
