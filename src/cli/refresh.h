#pragma once

#include "cli/options.h"
#include "cli/progress.h"

namespace parallux {

/// Rewrites the pictures while a solve goes on, from what it has so far. One that cannot be written
/// is told in one line on standard error, once; the run goes on, the next refresh tries again, and
/// the writing at the end decides the exit code.
class Refresh {
public:
    /// Keeps references to all.
    Refresh(const SolveOptions& options, const Scene& scene, const Patches& patches,
            ProgressReport& report)
        : options_(options), scene_(scene), patches_(patches), report_(report) {}

    void operator()(const Solution& so_far);

    /// What solve() takes: nothing to show where no refresh is wanted. Refers to this.
    Preview preview();

private:
    const SolveOptions& options_;
    const Scene& scene_;
    const Patches& patches_;
    ProgressReport& report_;
    bool told_ = false;
};

}  // namespace parallux
