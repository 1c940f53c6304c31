#pragma once

/// The request that asks a program to end: a signal, as app/link/stop_signals.h handles it, or anything else.
/// Long work looks at it, and so does every read that may have to wait.
namespace trimtab {

/// Asks the program to stop. It stays asked. May be called from any thread and from a signal handler.
void requestStop();
bool stopRequested();

}  // namespace trimtab
