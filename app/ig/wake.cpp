#include "wake.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>

namespace trimtab::ig {
namespace {

std::atomic<bool> stopped{false};
std::atomic<int> signalFd{-1};

void postTo(int fd) {
  const std::uint64_t one = 1;
  // Nothing can be done about a failure: the counter is full, so a wake-up is already on its way.
  [[maybe_unused]] const auto written = ::write(fd, &one, sizeof one);
}

void onSignal(int) {
  stopped = true;
  postTo(signalFd);
}

}  // namespace

Wake::Wake() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  signalFd = fd_;
  struct sigaction action {};
  action.sa_handler = onSignal;
  // A second signal ends the program at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

Wake::~Wake() {
  signalFd = -1;
  ::close(fd_);
}

void Wake::post() const {
  postTo(fd_);
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
  return stopped;
}

}  // namespace trimtab::ig
