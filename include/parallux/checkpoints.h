#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace parallux {

/// Keeps a run that goes on in a file, and takes it up again from one: to the same bits, on any
/// number of threads. The file is written on a thread of its own from a copy of the run's state,
/// and an older one stays whole until the newer one is.
struct Checkpoints {
    std::filesystem::path file;  ///< to write; empty: none
    /// To go on from, which may be the same; empty: begin anew. Fault::input for one that cannot be
    /// read, is damaged, or is of another version, scene, patches or settings, with both hashes.
    std::filesystem::path resume;
    /// Seconds, at least, from the start to the first and from one to the next. One more is written
    /// when the run is told to stop or its time is up, before solve() returns.
    double every = 60;
    /// Asked between batches, from the calling thread: true when one is wanted at once. Empty: no.
    std::function<bool()> wanted = {};
    /// Told from the calling thread, after each: why it could not be written, or "". The run goes
    /// on in any case. May be empty.
    std::function<void(const std::string& failure)> written = {};

    bool any() const { return !file.empty() || !resume.empty(); }
};

}  // namespace parallux
