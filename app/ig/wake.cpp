#include "wake.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdint>

#include "app/link/stop_signals.h"

namespace trimtab::ig {
namespace {

/// timeout(1) and a terminal that closes send their signal to the process and to its group: two signals
/// within this time are one request.
constexpr std::int64_t kSameRequestMs = 1000;

std::atomic<bool> stopped{false};
std::atomic<int> signalFd{-1};
std::atomic<std::int64_t> askedAtMs{0};

std::int64_t nowMs() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1000 + t.tv_nsec / 1000000;
}

void postTo(int fd) {
  const std::uint64_t one = 1;
  // Nothing can be done about a failure: the counter is full, so a wake-up is already on its way.
  [[maybe_unused]] const auto written = ::write(fd, &one, sizeof one);
}

/// The first request ends the loop, so that the trace is finished and the screenshot written; another one
/// ends the program at once.
void onSignal(int number) {
  const std::int64_t now = nowMs();
  if (stopped.exchange(true)) {
    if (now - askedAtMs <= kSameRequestMs) return;
    ::signal(number, SIG_DFL);
    ::raise(number);
    return;
  }
  askedAtMs = now;
  postTo(signalFd);
}

}  // namespace

Wake::Wake() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  signalFd = fd_;
  onStopSignals(onSignal);
  // Whoever reads our output may leave; the trace and the screenshot are written all the same.
  ::signal(SIGPIPE, SIG_IGN);
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
