#include "view_factors/counting.h"

#include <algorithm>
#include <utility>

#include "random.h"

namespace parallux {

Counting::Counting(PairSweep& sweep, PairCounts& counts, const FactorMemory& memory,
                   const FactorSettings& settings, const ProgressCallback& progress,
                   Factors& result)
    : sweep_(sweep),
      counts_(counts),
      memory_(memory),
      settings_(settings),
      progress_(progress),
      result_(result),
      // Groups are as long as one another, so that their spread tells the error.
      a_group_((settings.bundles - 1) / result.groups + 1) {
}

void Counting::run() {
    const std::uint32_t groups = std::exchange(result_.groups, 0);
    all_ = a_group_ * groups;
    for (std::uint32_t group = 0; group < groups && !result_.partial; ++group) {
        follow_group(group);
        counts_.end_group(result_.threads);
        ++result_.groups;
    }
}

void Counting::follow_group(std::uint32_t group) {
    const BundleSettings lattice{group == 0 ? settings_.seed : mix64(settings_.seed ^ mix64(group)),
                                 a_group_, settings_.directions, result_.line_spacing};
    for (std::uint64_t done = 0; done < a_group_ && !result_.partial;) {
        const auto count =
            static_cast<std::uint32_t>(std::min<std::uint64_t>(sweep_.at_once(), a_group_ - done));
        sweep_.bundles(lattice, done, count);
        done += count;
        result_.bundles += count;
        look_at_memory();
        report();
    }
}

// What a sixteenth of the first group has met, and twice as many, tell what all will; twice as many
// again tell it better.
void Counting::look_at_memory() {
    memory_.check_counts(counts_);
    if (result_.bundles > a_group_ || 16 * result_.bundles < look_ * a_group_)
        return;
    counts_.apply(result_.threads);
    const auto pairs = static_cast<double>(counts_.pairs());
    const auto done = static_cast<double>(result_.bundles);
    // A look may come late where bundles are followed many at a time.
    const double at_half = done < 3 * looked_at_ ? pairs_ : 0;
    result_.predicted_memory =
        memory_.check_pairs(pairs_to_come(at_half, pairs, done, static_cast<double>(all_)));
    pairs_ = pairs;
    looked_at_ = done;
    while (16 * result_.bundles >= look_ * a_group_)
        look_ *= 2;
}

void Counting::report() {
    if (!progress_)
        return;
    Progress progress;
    progress.stage = "bundles";
    progress.done = static_cast<double>(result_.bundles) / static_cast<double>(all_);
    progress.lines = sweep_.line_counts().lines;
    progress.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    result_.partial = !progress_(progress) && result_.bundles < all_;
}

}  // namespace parallux
