#pragma once

// Ctrl-C and SIGTERM. While there is nothing worth keeping the first one ends the program at once;
// from keep_results() on the first asks the solve to stop after its batch, the second ends the
// program at once.

namespace parallux {

inline constexpr int exit_interrupted = 130;

/// Call once, from the thread that will write the files.
void watch_signals();

/// From now on the first signal is answered with a partial result.
void keep_results();

/// True once a signal has come.
bool interrupted();

/// While one lives, a temporary file may exist: a signal that would end the program at once waits
/// for it, so that nothing is left behind. That is one file's writing, not its computing. Writing
/// takes place on the thread of watch_signals(), which also handles every signal: the two can not
/// overtake each other.
class WritingFile {
public:
    WritingFile();
    ~WritingFile();
    WritingFile(const WritingFile&) = delete;
    WritingFile& operator=(const WritingFile&) = delete;
};

}  // namespace parallux
