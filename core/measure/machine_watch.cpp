#include "trimtab/measure/machine_watch.h"

#include <sys/times.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

constexpr double kBusyShare = 0.1;
/// A hundredth is told apart from so many ticks on.
constexpr std::uint64_t kFewestTicks = 100;

/// What passed in pauses: all and busy ticks.
std::atomic<std::uint64_t> pausedAll{0}, pausedBusy{0};

std::optional<ProcessorTime> processorTimeNow() {
  std::ifstream stat("/proc/stat");
  std::string line;
  if (!std::getline(stat, line)) return std::nullopt;
  std::optional<ProcessorTime> now = parseProcessorTime(line);
  tms own{};
  if (now && times(&own) != static_cast<clock_t>(-1))
    now->own = static_cast<std::uint64_t>(own.tms_utime + own.tms_stime);
  if (now) now->all -= pausedAll, now->busy -= pausedBusy;
  return now;
}

}  // namespace

/// The line is "cpu user nice system idle iowait irq softirq steal ...". What follows is part of the first
/// two.
std::optional<ProcessorTime> parseProcessorTime(std::string_view stat) {
  if (!stat.starts_with("cpu ")) return std::nullopt;
  constexpr std::size_t kCounts = 8, kIdle = 3, kWaiting = 4;
  std::array<std::uint64_t, kCounts> counts{};
  const char* at = stat.data() + 4;
  const char* const end = stat.data() + stat.size();
  ProcessorTime time;
  for (std::size_t i = 0; i < kCounts; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto [next, error] = std::from_chars(at, end, counts[i]);
    if (error != std::errc()) return std::nullopt;
    at = next;
    time.all += counts[i];
    if (i != kIdle && i != kWaiting) time.busy += counts[i];
  }
  return time;
}

double othersShare(const ProcessorTime& before, const ProcessorTime& after) {
  // Counts of idle time may fall where processors go to sleep.
  if (after.all < before.all + kFewestTicks) return kNan;
  const double all = static_cast<double>(after.all - before.all);
  const double others = (static_cast<double>(after.busy) - static_cast<double>(before.busy)) -
                        (static_cast<double>(after.own) - static_cast<double>(before.own));
  return std::clamp(others / all, 0.0, 1.0);
}

MachineWatch::MachineWatch() : begin_(processorTimeNow()) {}

double MachineWatch::othersShare() const {
  const std::optional<ProcessorTime> now = begin_ ? processorTimeNow() : std::nullopt;
  return now ? trimtab::othersShare(*begin_, *now) : kNan;
}

void unwatched(const std::function<void()>& pause) {
  const std::optional<ProcessorTime> before = processorTimeNow();
  pause();
  const std::optional<ProcessorTime> after = processorTimeNow();
  if (!before || !after) return;
  pausedAll += after->all - before->all;
  pausedBusy += after->busy - before->busy;
}

bool isBusy(double othersShare) {
  return othersShare > kBusyShare;
}

std::string busyText(double othersShare) {
  if (!isBusy(othersShare)) return {};
  char text[160];
  std::snprintf(
      text, sizeof text,
      "The machine was busy: other programs took %.0f %% of its processors, so measure again when it "
      "is idle.",
      othersShare * 100);
  return text;
}

}  // namespace trimtab
