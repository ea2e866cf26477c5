#include "solve/leftover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solve/follow.h"

namespace parallux {

Leftover::Leftover(const Patches& patches, const Regions& regions, std::vector<double> planned,
                   unsigned threads)
    : ways(regions, threads),
      patches_(patches),
      regions_(regions),
      planned_(std::move(planned)),
      threads_(threads) {
}

double Leftover::held(const TransferState& state) {
    double most = 0;
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        const double sent = static_cast<double>(state.emitted[band] + state.sky[band]);
        const double finished = static_cast<double>(state.absorbed[band] + state.escaped[band]);
        if (sent > 0)
            most = std::max(most, (sent - finished) / sent);
    }
    return most;
}

// Quanta received and unshot, the area that light can reach, and what of that reflects: of every
// region, or group, and band.
struct Leftover::Sums {
    std::vector<double> received, unshot, area, reflecting;

    explicit Sums(std::size_t size)
        : received(size, 0), unshot(size, 0), area(size, 0), reflecting(size, 0) {}
    std::vector<double> reflectance() const {
        std::vector<double> mean(reflecting);
        for (std::size_t k = 0; k < mean.size(); ++k)
            mean[k] = area[k] > 0 ? reflecting[k] / area[k] : 0;
        return mean;
    }
};

Leftover::Sums Leftover::sums(const TransferState& state, const Banks& banks,
                              const std::vector<bool>& fine) const {
    const std::uint32_t bands = state.bands;
    Sums sums(std::size_t(regions_.count) * bands);
    for (std::size_t patch = 0; patch < patches_.count(); ++patch)
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::size_t k = patch * bands + band;
            const std::size_t r = regions_.of[patch] * std::size_t(bands) + band;
            const std::int64_t received = banks.received(patch, band);
            if (!reached(patch, received, fine[band]))
                continue;
            const double reflectance = patches_.reflectance[k];
            sums.received[r] += static_cast<double>(received);
            sums.unshot[r] += static_cast<double>(
                std::llrint(reflectance * static_cast<double>(received)) - state.sent[k]);
            sums.area[r] += patches_.area[patch];
            sums.reflecting[r] += patches_.area[patch] * reflectance;
        }
    return sums;
}

Leftover::Sums Leftover::grouped(const Sums& regions) const {
    const std::uint32_t bands = patches_.bands;
    Sums sums(std::size_t(regions_.groups) * bands);
    for (std::size_t k = 0; k < regions.area.size(); ++k) {
        const std::size_t g = regions_.group[k / bands] * std::size_t(bands) + k % bands;
        sums.received[g] += regions.received[k];
        sums.unshot[g] += regions.unshot[k];
        sums.area[g] += regions.area[k];
        sums.reflecting[g] += regions.reflecting[k];
    }
    return sums;
}

namespace {

// Quanta per m² of what each receives. Few lines do not leave all just as their areas ask: what a
// line brings in the mean has less noise than what an area receives, and is even where light has
// bounced for ever. All of them together receive the same.
std::vector<double> evened(std::vector<double> received, const std::vector<std::uint32_t>& exits,
                           const std::vector<double>& area, std::uint32_t bands) {
    std::array<double, max_bands> all{}, evened{};
    for (std::size_t k = 0; k < received.size(); ++k) {
        all[k % bands] += received[k];
        received[k] /= std::max(1u, exits[k / bands]);
        evened[k % bands] += received[k] * area[k];
    }
    for (std::size_t k = 0; k < received.size(); ++k)
        received[k] *= evened[k % bands] > 0 ? all[k % bands] / evened[k % bands] : 0;
    return received;
}

// Bands of which some groups, that matter, are still to receive much of what they receive.
std::vector<bool> much_to_come(const std::vector<double>& received,
                               const std::vector<double>& to_come, std::uint32_t bands) {
    constexpr double matters = 1.0 / 512;
    std::vector<double> waiting(bands, 0), all(bands, 0);
    for (std::size_t k = 0; k < received.size(); ++k) {
        const double sum = received[k] + to_come[k];
        all[k % bands] += sum;
        if (to_come[k] > Leftover::much * sum)
            waiting[k % bands] += sum;
    }
    std::vector<bool> much(bands);
    for (std::uint32_t band = 0; band < bands; ++band)
        much[band] = waiting[band] > matters * all[band];
    return much;
}

}  // namespace

// Emission that more or fewer lines carried than expected is corrected alike for all.
std::vector<double> Leftover::correction(const TransferState& state, double done) const {
    std::vector<double> factor(state.bands, 1);
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        const double sky = static_cast<double>(state.sky[band]);
        const double sent = static_cast<double>(state.emitted[band]) + sky;
        const double wanted = planned_[band] / state.watts_per_quantum + sky / done;
        if (sent > 0 && wanted > 0)
            factor[band] = wanted / sent;
    }
    return factor;
}

Leftover::Spread Leftover::spread(const TransferState& state, const Banks& banks,
                                  double done) const {
    const std::uint32_t bands = state.bands;
    Spread spread;
    spread.factor = correction(state, done);
    // Between groups, in each of which it is even.
    const std::vector<bool> only_reached(bands, false), all_of_a_region(bands, true);
    const Sums groups = grouped(sums(state, banks, only_reached));
    const GroupSystem between(ways.between_groups(), groups.reflectance(), bands, threads_);
    std::vector<double> to_come = between.follow(groups.unshot);
    spread.fine = much_to_come(groups.received, to_come, bands);
    to_come = evened(std::move(to_come), between.ways().exits, groups.area, bands);
    spread.to_come.resize(std::size_t(regions_.count) * bands);
    for (std::size_t r = 0; r < spread.to_come.size(); ++r)
        spread.to_come[r] = to_come[regions_.group[r / bands] * std::size_t(bands) + r % bands];
    if (spread.fine == only_reached)
        return spread;

    // From patch to patch.
    const Sums regions = sums(state, banks, all_of_a_region);
    const RegionWays between_regions = ways.between_regions();
    to_come = evened(follow(between_regions, regions.reflectance(), regions.unshot, bands,
                            regions_.group, between, threads_),
                     between_regions.exits, regions.area, bands);
    for (std::size_t r = 0; r < spread.to_come.size(); ++r)
        if (spread.fine[r % bands])
            spread.to_come[r] = to_come[r];
    return spread;
}

}  // namespace parallux
