#pragma once

namespace trimtab::ig {

/// Ends the sleep of the main thread on a packet, or once the program is asked to stop
/// (app/link/stop_signals.h).
class Wake {
 public:
  Wake();
  ~Wake();
  Wake(const Wake&) = delete;
  Wake& operator=(const Wake&) = delete;

  /// Ends the sleep. May be called from any thread and from a signal handler.
  void post() const;
  /// Sleeps until `post`, until `otherFd` is readable (-1: none), or for `seconds` (negative or infinite: no
  /// limit).
  void wait(double seconds, int otherFd) const;
  bool stop() const;

 private:
  int fd_ = -1;
};

}  // namespace trimtab::ig
