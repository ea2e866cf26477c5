#include "solve/leftover.h"

#include <algorithm>

namespace parallux {

Leftover::Leftover(const Scene& scene, const Patches& patches,
                   const std::vector<std::int64_t>& planned)
    : groups_(patches.count(), 0),
      count_(static_cast<std::uint32_t>(2 * scene.objects.size())),
      planned_(patches.bands, 0) {
    for (std::size_t k = 0; k < planned.size(); ++k)
        planned_[k % patches.bands] += planned[k];
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        std::uint32_t group = 2 * scene.surfaces[s].object;
        for (std::uint32_t cell = 0; cell < grid.nu * grid.nv; ++cell) {
            groups_[grid.front + cell] = group;
            if (grid.back != none)
                groups_[grid.back + cell] = group + 1;
        }
    }
}

void Leftover::note(const TransferState& state) {
    std::vector<double> sums(count_ * state.bands, 0);
    for (std::size_t patch = 0; patch < groups_.size(); ++patch)
        for (std::uint32_t band = 0; band < state.bands; ++band)
            sums[groups_[patch] * state.bands + band] +=
                static_cast<double>(state.received[patch * state.bands + band]);
    notes_.push_back(std::move(sums));
}

std::vector<double> Leftover::factors(const TransferState& state, const Patches& patches,
                                      double done) const {
    std::uint32_t bands = state.bands;
    std::vector<double> factors(count_ * bands, 1);
    std::vector<double> absorbed(count_ * bands, 0);
    for (std::size_t patch = 0; patch < groups_.size(); ++patch)
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::size_t k = patch * bands + band;
            absorbed[groups_[patch] * bands + band] +=
                (1 - static_cast<double>(patches.reflectance[k])) *
                static_cast<double>(state.received[k]);
        }
    for (std::uint32_t band = 0; band < bands; ++band) {
        double sky = static_cast<double>(state.sky[band]);
        double sent = static_cast<double>(state.emitted[band]) + sky;
        double finished = static_cast<double>(state.absorbed[band] + state.escaped[band]);
        double wanted = static_cast<double>(planned_[band]) + sky / done;
        if (!(sent > 0 && finished > 0 && wanted > 0))
            continue;
        // The share of each group's received energy that is still to come: after R1 and R2 in the
        // halves of the closing bundles, R2 (r + r² + …) with r = R2 / R1.
        std::vector<double> to_come(count_, 0);
        double would_finish = 0;
        for (std::uint32_t group = 0; notes_.size() == 3 && group < count_; ++group) {
            std::size_t k = group * bands + band;
            double first = notes_[1][k] - notes_[0][k], second = notes_[2][k] - notes_[1][k];
            if (!(first > 0 && second > 0))
                continue;
            double r = std::min(second / first, 0.9999);
            to_come[group] = second * r / (1 - r) / notes_[2][k];
            // What escapes goes with what is absorbed.
            would_finish += to_come[group] * absorbed[k] * finished /
                            static_cast<double>(std::max<std::int64_t>(1, state.absorbed[band]));
        }
        double unshot = sent - finished;
        for (std::uint32_t group = 0; group < count_; ++group) {
            double share =
                would_finish > 0 ? to_come[group] * unshot / would_finish : unshot / finished;
            // Emission that more or fewer lines carried than expected is corrected alike for all.
            factors[group * bands + band] = (1 + share) * wanted / sent;
        }
    }
    return factors;
}

}  // namespace parallux
