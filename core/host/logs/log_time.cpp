#include "log_time.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <vector>

#include "column_advice.h"
#include "delimited_text.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

/// Dates between 1979 and 2286; and no recording is longer than three thousand years.
constexpr double kEarliestDateS = 3e8, kLatestDateS = 1e10, kLongestS = 1e11;

/// Takes so many digits.
bool takeDigits(std::string_view& text, std::size_t count, int& number) {
  if (text.size() < count) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + count, number);
  if (error != std::errc{} || end != text.data() + count || number < 0) return false;
  text.remove_prefix(count);
  return true;
}

bool take(std::string_view& text, char mark) {
  if (!text.starts_with(mark)) return false;
  text.remove_prefix(1);
  return true;
}

/// Takes hh:mm[:ss[.fraction]].
bool takeTimeOfDay(std::string_view& text, double& seconds) {
  int hours = 0, minutes = 0, whole = 0;
  const std::size_t digits = text.find(':') == 1 ? 1 : 2;
  if (!takeDigits(text, digits, hours) || !take(text, ':') || !takeDigits(text, 2, minutes)) return false;
  if (hours > 24 || minutes > 59) return false;
  seconds = 3600.0 * hours + 60.0 * minutes;
  if (!take(text, ':')) return true;
  if (!takeDigits(text, 2, whole) || whole > 60) return false;
  seconds += whole;
  if (!text.starts_with('.') && !text.starts_with(',')) return true;
  const std::size_t end = std::min(text.find_first_not_of("0123456789", 1), text.size());
  const auto fraction = readNumber("0." + std::string(text.substr(1, std::min<std::size_t>(end - 1, 17))));
  if (end == 1 || !fraction) return false;
  seconds += *fraction;
  text.remove_prefix(end);
  return true;
}

/// Takes yyyy-mm-dd with dashes, slashes or nothing between, as seconds since 1970.
bool takeDate(std::string_view& text, double& seconds) {
  int year = 0, month = 0, day = 0;
  if (!takeDigits(text, 4, year)) return false;
  const char mark = text.starts_with('-') || text.starts_with('/') ? text.front() : '\0';
  const auto separator = [&] { return mark == '\0' || take(text, mark); };
  if (!separator() || !takeDigits(text, 2, month) || !separator() || !takeDigits(text, 2, day)) return false;
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month{static_cast<unsigned>(month)},
                                         std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return false;
  seconds = kDayS * static_cast<double>(std::chrono::sys_days{date}.time_since_epoch().count());
  return true;
}

constexpr std::array kUnits{Unit::seconds, Unit::milliseconds, Unit::microseconds, Unit::nanoseconds};

const char* nameOf(Unit unit) {
  switch (unit) {
    case Unit::milliseconds:
      return "milliseconds";
    case Unit::microseconds:
      return "microseconds";
    case Unit::nanoseconds:
      return "nanoseconds";
    default:
      return "seconds";
  }
}

/// Returns what a map writes before a column of times in this unit.
std::string keyOf(Unit unit) {
  switch (unit) {
    case Unit::milliseconds:
      return "time_ms=";
    case Unit::microseconds:
      return "time_us=";
    case Unit::nanoseconds:
      return "time_ns=";
    default:
      return "time_s=";
  }
}

bool isDate(std::span<const double> times, Unit unit) {
  const double scale = secondsOf(unit);
  return !times.empty() && times.front() * scale >= kEarliestDateS && times.back() * scale <= kLatestDateS;
}

double atShare(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Pace {
  std::size_t steps = 0;
  double step = 0;   ///< the median, in the column's unit
  double speed = 0;  ///< beyond which a twentieth of the rows lies, in that unit
};

Pace paceOf(std::span<const double> times, std::span<const double> moved) {
  std::vector<double> steps, speeds;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double step = times[i + 1] - times[i];
    if (!(step > 0)) continue;
    steps.push_back(step);
    if (i < moved.size()) speeds.push_back(moved[i] / step);
  }
  return {steps.size(), atShare(steps, 0.5), atShare(speeds, 0.95)};
}

std::vector<Unit> unitsThatFit(std::span<const double> times, const Pace& pace, const LogMotion& motion) {
  std::vector<Unit> fit, moving;
  for (const Unit unit : kUnits) {
    const double scale = secondsOf(unit), step = pace.step * scale, speed = pace.speed / scale;
    if (step < motion.shortestStepS || step > motion.longestStepS || speed > motion.fastest) continue;
    if (std::abs(times.front()) * scale > kLatestDateS) continue;
    fit.push_back(unit);
    if (speed >= motion.slowest) moving.push_back(unit);
  }
  if (fit.size() == 1) return fit;
  std::vector<Unit> dates;
  for (const Unit unit : kUnits)
    if (isDate(times, unit) && (fit.empty() || std::find(fit.begin(), fit.end(), unit) != fit.end()))
      dates.push_back(unit);
  if (dates.size() == 1 && moving.size() == 1 && dates != moving) return {dates[0], moving[0]};
  if (dates.size() == 1) return dates;
  return moving.size() == 1 ? moving : fit;
}

}  // namespace

std::optional<double> readClock(std::string_view cell) {
  std::string_view text = trimmed(cell);
  double date = 0, seconds = 0;
  std::string_view rest = text;
  if (takeDate(rest, date) && (take(rest, 'T') || take(rest, 't') || take(rest, ' ')))
    text = rest;
  else if (std::count(text.begin(), text.end(), ':') != 2)
    return std::nullopt;  // 12:34 may be hours and minutes, or minutes and seconds
  else
    date = 0;
  if (!takeTimeOfDay(text, seconds)) return std::nullopt;
  if (!take(text, 'Z') && !take(text, 'z') && !text.empty()) {
    const bool west = text.starts_with('-');
    double zone = 0;
    if (!take(text, '+') && !take(text, '-')) return std::nullopt;
    if (text.find(':') == std::string_view::npos) {
      int hours = 0, minutes = 0;
      if (!takeDigits(text, 2, hours) || (!text.empty() && !takeDigits(text, 2, minutes)))
        return std::nullopt;
      zone = 3600.0 * hours + 60.0 * minutes;
    } else if (!takeTimeOfDay(text, zone)) {
      return std::nullopt;
    }
    seconds -= west ? -zone : zone;
  }
  if (!text.empty()) return std::nullopt;
  return date + seconds;
}

double secondsOf(Unit unit) {
  switch (unit) {
    case Unit::milliseconds:
      return 1e-3;
    case Unit::microseconds:
      return 1e-6;
    case Unit::nanoseconds:
      return 1e-9;
    default:
      return 1;
  }
}

double dayAfter(double last, double time) {
  constexpr double kLongestGapS = 600;
  const double step = time + kDayS - last;
  return time < last && step >= 0 && step <= kLongestGapS ? kDayS : 0;
}

TimeReading timeReading(const TimeColumn& column, std::span<const double> times,
                        std::span<const double> moved, const LogMotion& motion, const std::string& where) {
  TimeReading reading;
  const auto say = [&](Severity severity, std::string expected, std::string found) {
    reading.findings.push_back({severity, where, column.name, std::move(expected), std::move(found)});
  };
  if (times.empty()) return reading;
  if (column.clock) {
    reading.fromFirst = true;
    say(Severity::note, "", "times of a clock: they are read as seconds from the first row on");
    if (times.back() - times.front() > kLongestS)
      say(Severity::error, "times of one recording", "times thousands of years apart");
    return reading;
  }
  Unit unit = column.unit;
  if (unit == Unit::none) {
    constexpr std::size_t kFewSteps = 5;  // these do not show a rate
    const Pace pace = paceOf(times, moved);
    const std::vector<Unit> fit = unitsThatFit(times, pace, motion);
    if (fit.size() > 1 && pace.steps >= kFewSteps) {
      say(Severity::error, "a unit of time in the column's name, as time_s or time_ms",
          "steps of " + numberText(pace.step, 3) + ", which may be " + nameOf(fit[0]) + " or " +
              nameOf(fit[1]) + ": " +
              mapAdvice({keyOf(fit[0]) + columnText(column.name), keyOf(fit[1]) + columnText(column.name)}));
      return reading;
    }
    unit = fit.size() == 1 ? fit[0] : Unit::seconds;
    reading.fromFirst = isDate(times, unit);
    if (fit.empty() && pace.steps >= kFewSteps)
      say(Severity::warning, "steps of time that seconds, milliseconds or less fit",
          numberText(pace.step, 3) +
              ": name the unit, or map the column, as time_s=" + columnText(column.name) + "*60");
    say(Severity::note, "",
        std::string("times name no unit: read as ") + nameOf(unit) +
            (reading.fromFirst ? " since 1970" : ""));
  } else if (unit == Unit::seconds && times.front() > kLongestS) {
    for (const Unit finer : {Unit::milliseconds, Unit::microseconds, Unit::nanoseconds})
      if (isDate(times, finer)) unit = finer;
    reading.fromFirst = true;
    say(Severity::warning, "times in seconds, as the column's name says",
        numberText(times.front()) + ", a date in " + nameOf(unit) + ": read as such");
  }
  reading.scale = secondsOf(unit);
  if (std::max(std::abs(times.front()), std::abs(times.back())) * reading.scale > kLongestS)
    say(Severity::error, "times or dates in seconds, milliseconds, microseconds or nanoseconds",
        numberText(times.front()) + ", which is none");
  return reading;
}

}  // namespace trimtab
