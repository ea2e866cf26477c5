#include "solve/leftover.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel.h"

namespace parallux {

namespace {
constexpr double faint = 100;
}

Leftover::Leftover(const Scene& scene, const Patches& patches, std::vector<double> planned,
                   unsigned threads)
    : scene_(scene),
      patches_(patches),
      count_(static_cast<std::uint32_t>(2 * scene.objects.size())),
      planned_(std::move(planned)),
      threads_(threads) {
    // Patches are numbered surface by surface; later surfaces may share those of an earlier one.
    std::uint32_t next = 0;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (patches.grids[s].front == next) {
            surfaces_.push_back(s);
            next +=
                patches.grids[s].nu * patches.grids[s].nv * (patches.grids[s].back == none ? 1 : 2);
        }
}

void Leftover::for_groups(
    std::size_t begin, std::size_t end,
    const std::function<void(std::size_t, std::size_t, std::uint32_t)>& visit) const {
    auto after = std::upper_bound(
        surfaces_.begin(), surfaces_.end(), begin,
        [&](std::size_t patch, std::uint32_t s) { return patch < patches_.grids[s].front; });
    for (auto own = after - 1; begin < end; ++own) {
        const SurfaceGrid& grid = patches_.grids[*own];
        const std::uint32_t group = 2 * scene_.surfaces[*own].object;
        const std::size_t middle = grid.front + std::size_t(grid.nu) * grid.nv;
        if (begin < middle)
            visit(begin, std::min(middle, end), group);
        begin = std::max(begin, middle);
        if (grid.back == none || begin >= end)
            continue;
        const std::size_t last = std::min(middle + std::size_t(grid.nu) * grid.nv, end);
        if (begin < last)
            visit(begin, last, group + 1);
        begin = std::max(begin, last);
    }
}

Leftover::Sums Leftover::sums(
    const std::function<std::int64_t(std::size_t, std::uint32_t)>& value) const {
    std::vector<Sums> by_worker(threads_, Sums(count_ * patches_.bands, 0));
    parallel_for(threads_, patches_.count(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     for_groups(begin, end,
                                [&](std::size_t first, std::size_t last, std::uint32_t group) {
                                    std::int64_t* sum = &by_worker[worker][group * patches_.bands];
                                    for (std::size_t patch = first; patch < last; ++patch)
                                        for (std::uint32_t band = 0; band < patches_.bands; ++band)
                                            sum[band] += value(patch, band);
                                });
                 });
    for (std::size_t worker = 1; worker < by_worker.size(); ++worker)
        for (std::size_t k = 0; k < by_worker[0].size(); ++k)
            by_worker[0][k] += by_worker[worker][k];
    return by_worker[0];
}

void Leftover::note(const Banks& banks) {
    notes_.push_back(
        sums([&](std::size_t patch, std::uint32_t band) { return banks.received(patch, band); }));
}

std::vector<double> Leftover::factors(const TransferState& state, const Banks& banks,
                                      double done) const {
    const std::uint32_t bands = state.bands;
    std::vector<double> factors(count_ * bands, 1);
    const Sums absorbed = sums([&](std::size_t patch, std::uint32_t band) {
        const std::int64_t received = banks.received(patch, band);
        return received -
               std::llrint(static_cast<double>(patches_.reflectance[patch * bands + band]) *
                           static_cast<double>(received));
    });
    for (std::uint32_t band = 0; band < bands; ++band) {
        double sky = static_cast<double>(state.sky[band]);
        double sent = static_cast<double>(state.emitted[band]) + sky;
        double finished = static_cast<double>(state.absorbed[band] + state.escaped[band]);
        double wanted = planned_[band] / state.watts_per_quantum + sky / done;
        if (!(sent > 0 && finished > 0 && wanted > 0))
            continue;
        // The share of each group's received energy that is still to come: after R1 and R2 in the
        // halves of the closing bundles, R2 (r + r² + …) with r = R2 / R1.
        std::vector<double> to_come(count_, 0);
        double would_finish = 0;
        for (std::uint32_t group = 0; notes_.size() == 3 && group < count_; ++group) {
            std::size_t k = group * bands + band;
            const double first = static_cast<double>(notes_[1][k] - notes_[0][k]);
            const double second = static_cast<double>(notes_[2][k] - notes_[1][k]);
            // Of too few quanta the fall tells nothing.
            if (!(first > faint && second > faint))
                continue;
            double r = std::min(second / first, 0.9999);
            to_come[group] = second * r / (1 - r) / static_cast<double>(notes_[2][k]);
            // What escapes goes with what is absorbed.
            would_finish += to_come[group] * static_cast<double>(absorbed[k]) * finished /
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
