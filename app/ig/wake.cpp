#include "wake.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>

#include "app/link/stop_signals.h"
#include "trimtab/preset/stop_request.h"

namespace trimtab::ig {

Wake::Wake() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  countStopSignals(fd_);
  // Whoever reads our output may leave; the trace and the screenshot are written all the same.
  ::signal(SIGPIPE, SIG_IGN);
}

Wake::~Wake() {
  countStopSignals(-1);
  ::close(fd_);
}

void Wake::post() const {
  const std::uint64_t one = 1;
  // Nothing can be done about a failure: the counter is full, so a wake-up is already on its way.
  [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
}

void Wake::wait(double seconds, int otherFd) const {
  pollfd fds[2] = {{fd_, POLLIN, 0}, {otherFd, POLLIN, 0}};
  const bool endless = !(seconds >= 0 && std::isfinite(seconds));
  // Rounded up: a wait that ends a moment early would be followed by a busy one.
  const int milliseconds = endless ? -1 : static_cast<int>(std::ceil(std::fmin(seconds, 3600) * 1e3));
  ::poll(fds, otherFd < 0 ? 1 : 2, milliseconds);
  std::uint64_t count = 0;
  [[maybe_unused]] const auto drained = ::read(fd_, &count, sizeof count);
}

bool Wake::stop() const {
  return stopRequested();
}

}  // namespace trimtab::ig
