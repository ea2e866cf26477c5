#include "solve/leftover.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel.h"

namespace parallux {

Leftover::Leftover(const Patches& patches, const Regions& regions, std::vector<double> planned,
                   unsigned threads)
    : patches_(patches),
      regions_(regions),
      planned_(std::move(planned)),
      threads_(threads),
      counts_(threads) {
}

void Leftover::count(const TilePairs& pairs, unsigned worker) {
    const std::size_t row = regions_.count + 1;
    std::vector<std::uint64_t>& counts = counts_[worker];
    counts.resize(regions_.count * row, 0);
    for (std::size_t k = 0; k < pairs.from.count; ++k) {
        const std::size_t a = regions_.of[pairs.from.ids[k]], b = regions_.of[pairs.to.ids[k]];
        ++counts[a * row + b];
        ++counts[b * row + a];
    }
    for (const PatchList* out : {&pairs.first, &pairs.last, &pairs.into_backs, &pairs.from_backs})
        for (std::size_t k = 0; k < out->count; ++k)
            ++counts[regions_.of[out->ids[k]] * row + regions_.count];
}

// The share of what leaves a region that comes to each. Few lines do not leave the regions just as
// their areas ask: counts are scaled alike by row and column until they do (R. Sinkhorn, A
// Relationship between Arbitrary Positive Matrices and Doubly Stochastic Matrices, 1964), so that
// light that has bounced for ever is even.
std::vector<double> Leftover::ways() const {
    const std::size_t n = regions_.count, row = n + 1;
    std::vector<double> ways(n * row, 0), area(n, 0), scale(row, 1), all(n);
    for (const std::vector<std::uint64_t>& counts : counts_)
        for (std::size_t k = 0; k < counts.size(); ++k)
            ways[k] += static_cast<double>(counts[k]);
    for (std::size_t patch = 0; patch < patches_.count(); ++patch)
        area[regions_.of[patch]] += patches_.area[patch];
    constexpr int rounds = 30;
    for (int round = 0; round <= rounds; ++round) {
        for (std::size_t from = 0; from < n; ++from) {
            all[from] = 0;
            for (std::size_t to = 0; to <= n; ++to)
                all[from] += ways[from * row + to] * scale[to];
        }
        for (std::size_t from = 0; round < rounds && from < n; ++from)
            if (all[from] > 0)
                scale[from] = std::sqrt(scale[from] * area[from] / all[from]);
    }
    for (std::size_t from = 0; from < n; ++from)
        for (std::size_t to = 0; all[from] > 0 && to <= n; ++to)
            ways[from * row + to] *= scale[to] / all[from];
    return ways;
}

// Of every region and band: quanta unshot, the area that light has reached, and what of it
// reflects.
struct Leftover::Sums {
    std::vector<std::int64_t> unshot;
    std::vector<double> area, reflecting;
};

Leftover::Sums Leftover::sums(const TransferState& state, const Banks& banks) const {
    const std::uint32_t bands = state.bands;
    Sums sums;
    sums.unshot.resize(regions_.count * bands, 0);
    sums.area.resize(regions_.count * bands, 0);
    sums.reflecting.resize(regions_.count * bands, 0);
    for (std::size_t patch = 0; patch < patches_.count(); ++patch)
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::size_t k = patch * bands + band, r = regions_.of[patch] * bands + band;
            const std::int64_t received = banks.received(patch, band);
            if (received <= 0)
                continue;
            const double reflectance = patches_.reflectance[k];
            sums.unshot[r] +=
                std::llrint(reflectance * static_cast<double>(received)) - state.sent[k];
            sums.area[r] += patches_.area[patch];
            sums.reflecting[r] += patches_.area[patch] * reflectance;
        }
    return sums;
}

// Solves x_to = Σ ways(from, to) (u_from + ρ_from x_from): quanta that come to each region until
// all is absorbed. Columns of 1 - ρ ways are ruled by their diagonal, so that no row need be
// exchanged.
std::vector<double> Leftover::follow(const std::vector<double>& ways, const Sums& sums,
                                     std::uint32_t band) const {
    const std::size_t n = regions_.count, bands = patches_.bands;
    std::vector<double> matrix(n * n), x(n, 0);
    for (std::size_t from = 0; from < n; ++from) {
        const std::size_t r = from * bands + band;
        const double reflectance = sums.area[r] > 0 ? sums.reflecting[r] / sums.area[r] : 0;
        for (std::size_t to = 0; to < n; ++to) {
            const double way = ways[from * (n + 1) + to];
            matrix[to * n + from] = (from == to ? 1 : 0) - reflectance * way;
            x[to] += way * static_cast<double>(sums.unshot[r]);
        }
    }
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t row = k + 1; row < n; ++row) {
            const double times = matrix[row * n + k] / matrix[k * n + k];
            if (times == 0)
                continue;
            for (std::size_t column = k; column < n; ++column)
                matrix[row * n + column] -= times * matrix[k * n + column];
            x[row] -= times * x[k];
        }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t column = k + 1; column < n; ++column)
            x[k] -= matrix[k * n + column] * x[column];
        x[k] /= matrix[k * n + k];
    }
    return x;
}

Leftover::Spread Leftover::spread(const TransferState& state, const Banks& banks,
                                  double done) const {
    const std::uint32_t bands = state.bands;
    Spread spread;
    spread.factor.assign(bands, 1);
    spread.even.assign(regions_.count * bands, 0);
    const Sums sums = this->sums(state, banks);
    const std::vector<double> ways = this->ways();
    for (std::uint32_t band = 0; band < bands; ++band) {
        const double sky = static_cast<double>(state.sky[band]);
        const double sent = static_cast<double>(state.emitted[band]) + sky;
        const double wanted = planned_[band] / state.watts_per_quantum + sky / done;
        if (!(sent > 0 && wanted > 0))
            continue;
        // Emission that more or fewer lines carried than expected is corrected alike for all.
        spread.factor[band] = wanted / sent;
        const std::vector<double> to_come = follow(ways, sums, band);
        for (std::size_t region = 0; region < regions_.count; ++region) {
            const std::size_t r = region * bands + band;
            if (sums.area[r] > 0)
                spread.even[r] = to_come[region] / sums.area[r];
        }
    }
    return spread;
}

}  // namespace parallux
