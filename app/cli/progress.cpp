#include "progress.h"

#include <atomic>
#include <chrono>
#include <iomanip>
#include <iostream>

#include "app/link/stop_signals.h"

namespace trimtab::cli {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void stopWhenAsked() {
  interrupted = false;
  onStopSignals([](int) { interrupted = true; });
}

std::function<bool(double, const std::string&)> progressLines() {
  using Clock = std::chrono::steady_clock;
  return
      [last = Clock::time_point{}, said = std::string()](double fraction, const std::string& what) mutable {
        const Clock::time_point now = Clock::now();
        if (what != said || now - last > std::chrono::milliseconds(500)) {
          last = now;
          said = what;
          std::cerr << std::setw(3) << static_cast<int>(fraction * 100) << " % " << what << '\n';
        }
        return !interrupted;
      };
}

}  // namespace trimtab::cli
