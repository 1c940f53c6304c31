#pragma once

#include <functional>
#include <string>

namespace trimtab::cli {

/// From now on a request to stop (app/link/stop_signals.h) asks the work to stop instead of ending the
/// program, so that no half-written file is left.
void stopWhenAsked();

/// Returns a function that prints progress on standard error, at most a few lines per second. It returns
/// false once the program was asked to stop.
std::function<bool(double fraction, const std::string& what)> progressLines();

}  // namespace trimtab::cli
