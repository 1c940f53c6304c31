#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace trimtab::cli {

/// Says of a command that its work looks at stopRequested(), so that a signal asks it to stop instead of
/// ending the program, and no half-written file is left.
void stopWhenAsked(const CLI::App& command);
/// Reports whether the command that the program was called with is one of these.
bool stopsWhenAsked(const CLI::App& program);

/// Returns a function that prints progress on standard error, at most a few lines per second. It returns
/// false once the program was asked to stop. From now on Ctrl+Z stops the program only in this function, so
/// whoever times something calls it in no timed stretch.
std::function<bool(double fraction, const std::string& what)> progressLines();

}  // namespace trimtab::cli
