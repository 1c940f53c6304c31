#pragma once

namespace trimtab {

/// From now on SIGINT, SIGTERM, and SIGHUP when the terminal is lost (unless nohup(1) has that ignored) call
/// requestStop(); another one more than a second later ends the program at once. Every main() begins with it,
/// so that a program is asked to stop in the same way at any time.
void handleStopSignals();

/// From now on the first of these signals ends the program at once, for work that never looks at
/// stopRequested(). One that came already ends it now.
void endAtStopSignals();

/// Adds 1 to the count of an eventfd once the program is asked to stop, or now if it was asked already; -1:
/// to none.
void countStopSignals(int eventDescriptor);

/// From now on SIGTSTP, as Ctrl+Z sends it, waits for pauseIfAsked(): a program that stops while it times an
/// image would count the pause. Call it before threads are made, which then hold the signal as well.
void holdPauses();
/// Reports whether SIGTSTP has come and waits.
bool pauseAsked();
/// Stops the whole program here if SIGTSTP has come, and returns once SIGCONT goes on with it. A SIGCONT that
/// comes before takes the SIGTSTP back.
void pauseIfAsked();

}  // namespace trimtab
