#pragma once

#include <csignal>

namespace trimtab {

/// Calls `handler` whenever the program is asked to stop: by SIGINT, by SIGTERM, and by SIGHUP when its
/// terminal is lost, unless nohup(1) has that ignored. `handler` may only do what is safe in a signal
/// handler.
inline void onStopSignals(void (*handler)(int), int flags = 0) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    ::sigaction(number, nullptr, &before);
    if (number != SIGHUP || before.sa_handler != SIG_IGN) ::sigaction(number, &action, nullptr);
  }
}

}  // namespace trimtab
