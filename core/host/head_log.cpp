#include "trimtab/host/head_log.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "limits.h"

namespace trimtab {
namespace {

constexpr double kDefaultWaitS = 2, kMostDeg = 1e6, kMostS = 3600;

Finding sweepFinding(std::string_view text) {
  return {Severity::error, "--head", "",
          "sweep:DEGREES/SECONDS[/WAIT] or nod:DEGREES/SECONDS[/WAIT], a nod of at most 180 degrees, "
          "more than 0 seconds",
          '"' + std::string(text) + '"'};
}

/// Reads a number off the front of `text`, with or without its unit.
bool takeNumber(std::string_view& text, std::string_view unit, double& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (text.starts_with(unit)) text.remove_prefix(unit.size());
  return true;
}

}  // namespace

bool isSweep(std::string_view text) {
  return text.starts_with("sweep:") || text.starts_with("nod:");
}

Result<HeadLog> parseSweep(std::string_view text) {
  const std::string_view whole = text;
  if (!isSweep(text)) return sweepFinding(whole);
  const bool nod = text.starts_with("nod:");
  text.remove_prefix(text.find(':') + 1);
  double angle = 0, seconds = 0, wait = kDefaultWaitS;
  const auto take = [&text](char mark) {
    const bool there = !text.empty() && text.front() == mark;
    if (there) text.remove_prefix(1);
    return there;
  };
  bool good = takeNumber(text, "deg", angle) && take('/') && takeNumber(text, "s", seconds);
  if (good && take('/')) good = takeNumber(text, "s", wait);
  if (!good || !text.empty() || std::abs(angle) > (nod ? 180 : kMostDeg) || !(seconds > 0) ||
      seconds > kMostS || !(wait >= 0) || wait > kMostS)
    return sweepFinding(whole);

  HeadLog log;
  log.name = whole;
  log.repeats = true;
  const double times[] = {0, wait, wait + seconds, 2 * wait + seconds, 2 * (wait + seconds)};
  const double sides[] = {-0.5, -0.5, 0.5, 0.5, -0.5};
  for (int i = 0; i < 5; ++i) {
    HeadSample sample;
    sample.timeS = times[i];
    (nod ? sample.pitchDeg : sample.headingDeg) = sides[i] * angle;
    // If there is no wait between them, the corners before and after it are one.
    if (!log.samples.empty() && log.samples.back().timeS == sample.timeS) continue;
    log.samples.push_back(sample);
  }
  return log;
}

Result<HeadLog> openHead(const std::string& text, BadRows badRows, const ColumnMap& columns) {
  return isSweep(text) ? parseSweep(text) : readHeadLog(text, badRows, columns);
}

Attitude headAt(const HeadLog& log, double timeS) {
  if (log.samples.empty()) return {};
  if (!std::isfinite(timeS)) timeS = 0;
  const double duration = log.durationS();
  if (log.repeats && duration > 0) {
    timeS = std::fmod(timeS, duration);
    if (timeS < 0) timeS += duration;
  }
  const auto attitude = [](double heading, double pitch, double roll) {
    return Attitude{wrapped180(Degrees{heading}), Degrees{limits::clampedPitch(pitch)},
                    wrapped180(Degrees{roll})};
  };
  const auto exactly = [&](const HeadSample& s) { return attitude(s.headingDeg, s.pitchDeg, s.rollDeg); };
  const auto after = std::upper_bound(log.samples.begin(), log.samples.end(), timeS,
                                      [](double t, const HeadSample& s) { return t < s.timeS; });
  if (after == log.samples.begin()) return exactly(*after);
  const HeadSample& a = *(after - 1);
  if (after == log.samples.end() || timeS == a.timeS || after->timeS - a.timeS > log.gapS) return exactly(a);
  const double share = (timeS - a.timeS) / (after->timeS - a.timeS);
  const auto between = [share](double from, double to) { return from + (to - from) * share; };
  return attitude(between(a.headingDeg, after->headingDeg), between(a.pitchDeg, after->pitchDeg),
                  between(a.rollDeg, after->rollDeg));
}

}  // namespace trimtab
