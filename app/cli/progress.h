#pragma once

#include <csignal>
#include <functional>
#include <string>

namespace trimtab::cli {

/// SIGINT asks the work to stop instead of ending the program, so that nothing half-made is left.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  void (*before_)(int);
};

/// Progress as lines on standard error, at most a few a second; false once interrupted.
std::function<bool(double fraction, const std::string& what)> progressLines();

}  // namespace trimtab::cli
