#pragma once

// Ctrl-C and SIGTERM. While there is nothing worth keeping the first one ends the program at once;
// from keep_results() on the first asks the solve to stop after its batch, the second ends the
// program at once. SIGUSR1 asks for a checkpoint. No temporary file is left behind.

namespace parallux {

inline constexpr int exit_interrupted = 130;

/// Call once.
void watch_signals();

/// From now on an exception that a library lets out of a function which promises none (as the
/// parser of arguments does when memory ends) also ends the program with its line and its exit
/// code.
void end_cleanly();

/// From now on the first signal is answered with a partial result.
void keep_results();

/// True once a signal has come.
bool interrupted();

/// True once after each SIGUSR1.
bool checkpoint_wanted();

}  // namespace parallux
