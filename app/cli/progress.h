#pragma once

#include <csignal>
#include <functional>
#include <string>

namespace trimtab::cli {

/// While it exists, SIGINT asks the work to stop instead of ending the program, so that no half-written file
/// is left.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  void (*before_)(int);
};

/// Returns a function that prints progress on standard error, at most a few lines per second. It returns
/// false once SIGINT has come.
std::function<bool(double fraction, const std::string& what)> progressLines();

}  // namespace trimtab::cli
