#include "solve/leftover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "solve/follow.h"
#include "solve/follow_through.h"

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
// region, or group, and band; and what lets light through from one to another.
struct Leftover::Sums {
    std::vector<double> received, unshot, area, reflecting;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<double, max_bands>> letting;

    explicit Sums(std::size_t size)
        : received(size, 0), unshot(size, 0), area(size, 0), reflecting(size, 0) {}
    std::vector<double> reflectance() const {
        std::vector<double> mean(reflecting);
        for (std::size_t k = 0; k < mean.size(); ++k)
            mean[k] = area[k] > 0 ? reflecting[k] / area[k] : 0;
        return mean;
    }
    std::vector<Crossing> crossings(std::uint32_t bands) const {
        std::vector<Crossing> result;
        for (const auto& [ways, sums] : letting) {
            Crossing one{ways.first, ways.second, sums};
            for (std::size_t band = 0; band < bands; ++band)
                one.share[band] /= area[one.from * bands + band];
            result.push_back(one);
        }
        return result;
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
            // A side in the dark sends what comes through from the other one.
            const bool lit = reached(patch, received, fine[band]);
            if (lit || patches_.translucent())
                sums.unshot[r] += static_cast<double>(
                    scattered_quanta(
                        patches_, k,
                        [&](std::size_t at) { return banks.received(at / bands, band); }) -
                    state.sent[k]);
            if (!lit)
                continue;
            sums.received[r] += static_cast<double>(received);
            sums.area[r] += patches_.area[patch];
            sums.reflecting[r] += patches_.area[patch] * double(patches_.reflectance[k]);
            if (patches_.translucent() && patches_.other[patch] != none)
                sums.letting[{regions_.of[patch], regions_.of[patches_.other[patch]]}][band] +=
                    patches_.area[patch] * double(patches_.transmittance[k]);
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
    for (const auto& [way, through] : regions.letting) {
        auto& sum = sums.letting[{regions_.group[way.first], regions_.group[way.second]}];
        for (std::size_t band = 0; band < bands; ++band)
            sum[band] += through[band];
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

// The same where light goes through surfaces: between groups, then from patch to patch.
Leftover::Spread Leftover::spread_through(const TransferState& state, const Banks& banks,
                                          const Sums& groups, Spread spread) const {
    const std::uint32_t bands = state.bands;
    const GroupWays between = ways.between_groups();
    const std::size_t n = between.groups;
    auto neighbours = [&](const std::vector<double>& values) {
        std::vector<double> sums(values.size(), 0);
        for (std::size_t from = 0; from < n; ++from)
            for (std::size_t to = 0; to < n; ++to)
                for (std::size_t band = 0; band < bands; ++band)
                    sums[to * bands + band] +=
                        between.lines[from * n + to] * values[from * bands + band];
        return sums;
    };
    std::vector<std::uint32_t> each(n);
    std::iota(each.begin(), each.end(), 0u);
    std::vector<double> to_come =
        follow_through({bands, groups.reflectance(), groups.received, each, groups.crossings(bands),
                        between.exits, neighbours},
                       groups.unshot);
    spread.fine = much_to_come(groups.received, to_come, bands);
    to_come = evened(std::move(to_come), between.exits, groups.area, bands);
    spread.to_come.resize(std::size_t(regions_.count) * bands);
    for (std::size_t r = 0; r < spread.to_come.size(); ++r)
        spread.to_come[r] = to_come[regions_.group[r / bands] * std::size_t(bands) + r % bands];
    if (spread.fine == std::vector<bool>(bands, false))
        return spread;

    const Sums regions = sums(state, banks, std::vector<bool>(bands, true));
    const RegionWays between_regions = ways.between_regions();
    auto of_regions = [&](const std::vector<double>& values) {
        std::vector<double> sums(values.size(), 0);
        between_regions.add_neighbours(values, bands, threads_, sums);
        return sums;
    };
    to_come = evened(follow_through({bands, regions.reflectance(), regions.received, regions_.group,
                                     regions.crossings(bands), between_regions.exits, of_regions},
                                    regions.unshot),
                     between_regions.exits, regions.area, bands);
    for (std::size_t r = 0; r < spread.to_come.size(); ++r)
        if (spread.fine[r % bands])
            spread.to_come[r] = to_come[r];
    return spread;
}

Leftover::Spread Leftover::spread(const TransferState& state, const Banks& banks,
                                  double done) const {
    const std::uint32_t bands = state.bands;
    Spread spread;
    spread.factor = correction(state, done);
    // Between groups, in each of which it is even.
    const std::vector<bool> only_reached(bands, false), all_of_a_region(bands, true);
    const Sums groups = grouped(sums(state, banks, only_reached));
    if (patches_.translucent())
        return spread_through(state, banks, groups, std::move(spread));
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
    to_come = evened(follow(between_regions, regions.reflectance(), regions.unshot,
                            regions.received, bands, regions_.group, between, threads_),
                     between_regions.exits, regions.area, bands);
    for (std::size_t r = 0; r < spread.to_come.size(); ++r)
        if (spread.fine[r % bands])
            spread.to_come[r] = to_come[r];
    return spread;
}

}  // namespace parallux
