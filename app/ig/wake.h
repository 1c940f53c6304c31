#pragma once

#include <atomic>

namespace trimtab::ig {

/// What ends the main thread's sleep: a packet, a signal. SIGINT and SIGTERM set `stop` from construction on.
class Wake {
 public:
  Wake();
  ~Wake();
  Wake(const Wake&) = delete;
  Wake& operator=(const Wake&) = delete;

  /// From any thread, and from a signal handler.
  void post() const;
  /// Sleeps until `post`, until `otherFd` (none: -1) can be read, or for `seconds` (negative or infinite: no
  /// limit).
  void wait(double seconds, int otherFd) const;
  bool stop() const;

 private:
  int fd_ = -1;
};

}  // namespace trimtab::ig
