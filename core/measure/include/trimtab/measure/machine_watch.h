#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace trimtab {

/// Processor time in the system's clock ticks: of all processors, and of what this program used of it.
struct ProcessorTime {
  std::uint64_t all = 0, busy = 0, own = 0;
};

/// Reads the line of all processors in the text of /proc/stat; `own` stays 0. Returns nothing if there is
/// none.
std::optional<ProcessorTime> parseProcessorTime(std::string_view stat);

/// Returns the share, 0 to 1, of the time of all processors between two readings that neither idled nor was
/// this program's own. It is NaN if there is too little time between them to tell.
double othersShare(const ProcessorTime& before, const ProcessorTime& after);

/// Finds out whether the machine was busy while something was measured: what other programs took of its
/// processors since the watch was made. Children that run are other programs.
class MachineWatch {
 public:
  MachineWatch();
  /// Returns the share of all processors' time that other programs took, 0 to 1; NaN if the system does not
  /// say it, or for less than about a second of processor time. Costs the reading of a small file.
  double othersShare() const;

 private:
  std::optional<ProcessorTime> begin_;
};

/// Calls `pause`, in which this program measures nothing: no watch counts what others took meanwhile.
void unwatched(const std::function<void()>& pause);

/// Returns whether times that were measured meanwhile may be those of a busy machine. Unknown is not busy.
bool isBusy(double othersShare);
/// Returns a sentence for beside such times; empty if the machine was not busy.
std::string busyText(double othersShare);

}  // namespace trimtab
