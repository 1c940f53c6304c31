#include "progress.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iomanip>
#include <iostream>
#include <vector>

#include "app/link/stop_signals.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/preset/stop_request.h"

namespace trimtab::cli {
namespace {

std::vector<const CLI::App*> stopping;

}  // namespace

void stopWhenAsked(const CLI::App& command) {
  stopping.push_back(&command);
}

bool stopsWhenAsked(const CLI::App& program) {
  const auto given = program.get_subcommands();
  return std::any_of(given.begin(), given.end(), [](const CLI::App* command) {
    return std::find(stopping.begin(), stopping.end(), command) != stopping.end() || stopsWhenAsked(*command);
  });
}

std::function<bool(double, const std::string&)> progressLines() {
  using Clock = std::chrono::steady_clock;
  holdPauses();
  return
      [last = Clock::time_point{}, said = std::string()](double fraction, const std::string& what) mutable {
        if (pauseAsked()) unwatched(pauseIfAsked);
        const Clock::time_point now = Clock::now();
        if (what != said || now - last > std::chrono::milliseconds(500)) {
          last = now;
          said = what;
          std::cerr << std::setw(3) << static_cast<int>(fraction * 100) << " % " << what << '\n';
        }
        return !stopRequested();
      };
}

}  // namespace trimtab::cli
