#include "app/link/stop_signals.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>

#include "trimtab/preset/stop_request.h"

namespace trimtab {
namespace {

/// timeout(1) and a terminal that closes send their signal to the process and to its group: two signals
/// within this time are one request.
constexpr std::int64_t kSameRequestMs = 1000;

std::atomic<std::int64_t> firstAtMs{0};  ///< 0: none came
std::atomic<int> firstSignal{0};
std::atomic<int> stopEvent{-1};
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler sets it");

std::int64_t nowMs() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1000 + t.tv_nsec / 1000000;
}

void endBy(int number) {
  std::signal(number, SIG_DFL);
  std::raise(number);
}

void countUp() {
  const std::uint64_t one = 1;
  // Nothing can be done about a failure: the counter is full, so a wake-up is already on its way.
  [[maybe_unused]] const auto written = ::write(stopEvent, &one, sizeof one);
}

void onSignal(int number) {
  const int before = errno;
  std::int64_t first = 0;
  const std::int64_t now = nowMs();
  if (firstAtMs.compare_exchange_strong(first, now)) {
    firstSignal = number;
    requestStop();
    countUp();
  } else if (now - first > kSameRequestMs) {
    endBy(number);
  }
  errno = before;
}

sigset_t pauseSignal() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTSTP);
  return set;
}

}  // namespace

void handleStopSignals() {
  struct sigaction action {};
  action.sa_handler = onSignal;
  // Libraries take an interrupted call for a failure. What may wait for ever is a poll(), which ends all the
  // same.
  action.sa_flags = SA_RESTART;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    if (number != SIGHUP || before.sa_handler != SIG_IGN) ::sigaction(number, &action, nullptr);
  }
}

void endAtStopSignals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    if (before.sa_handler == onSignal) std::signal(number, SIG_DFL);
  }
  if (firstSignal != 0) endBy(firstSignal);
}

void countStopSignals(int eventDescriptor) {
  stopEvent = eventDescriptor;
  if (stopRequested()) countUp();
}

// Blocked rather than handled: a handler's flag could be looked at just before SIGCONT, and the program would
// stop after it for good.
void holdPauses() {
  const sigset_t set = pauseSignal();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

bool pauseAsked() {
  sigset_t waiting;
  return ::sigpending(&waiting) == 0 && sigismember(&waiting, SIGTSTP) == 1;
}

void pauseIfAsked() {
  const sigset_t set = pauseSignal();
  ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

}  // namespace trimtab
