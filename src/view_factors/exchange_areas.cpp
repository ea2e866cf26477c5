#include "view_factors/exchange_areas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "view_factors/scale.h"

namespace parallux {

namespace {

std::vector<double> areas_of(const std::vector<FactorNode>& nodes) {
    std::vector<double> area(nodes.size());
    for (std::size_t i = 0; i < area.size(); ++i)
        area[i] = nodes[i].area;
    return area;
}

// Leaves entries out that are below the threshold both ways and not the largest of a row.
SparseRows without_small(const SparseRows& counts, const Account& account,
                         const std::vector<double>& area, double threshold) {
    const SparseRows& exchange = account.exchange;
    std::vector<double> largest(area.size(), 0);
    for (std::size_t i = 0; i < area.size(); ++i)
        for (std::uint64_t k = exchange.start[i]; k < exchange.start[i + 1]; ++k)
            largest[i] = std::max(largest[i], exchange.value[k]);
    return kept(counts, [&](std::size_t i, std::uint64_t k) {
        const double x = exchange.value[k];
        const std::uint32_t j = counts.column[k];
        return x >= threshold * std::min(area[i], area[j]) || x >= largest[i] || x >= largest[j];
    });
}

// What goes outside of each node, m²: what is scaled with its row, and what stays.
struct Outside {
    std::vector<double> scaled, fixed;
};

// The sky as it is known, but for the share `loose`; ground and backs as counted.
Outside outside_of(const PairCounts& counts, double cell, const std::vector<double>& area,
                   const std::optional<SkyShares>& known, double loose) {
    Outside outside{std::vector<double>(area.size(), 0), std::vector<double>(area.size(), 0)};
    for (std::size_t k = 0; k < counts.outside().size(); ++k)
        if (!known || k % counts.outsides() + 2 >= counts.outsides())
            outside.scaled[k / counts.outsides()] +=
                cell * static_cast<double>(counts.outside()[k]);
    for (std::size_t i = 0; known && i < area.size(); ++i) {
        outside.fixed[i] = (1 - loose) * area[i] * known->sky[i];
        // A row that no line left has nothing that could be scaled.
        outside.scaled[i] += counts.exits()[i] > 0 ? loose * area[i] * known->sky[i] : 0;
    }
    return outside;
}

Account close_rows(SparseRows rows, const Outside& outside, const std::vector<double>& area,
                   const FactorSettings& settings, Factors& factors) {
    std::vector<double> open(area);
    for (std::size_t i = 0; i < area.size(); ++i)
        open[i] -= outside.fixed[i];
    if (!(settings.threshold > 0))
        return close_account(std::move(rows), outside.scaled, open, {}, factors.threads);
    const Account account = close_account(rows, outside.scaled, open, {}, factors.threads);
    SparseRows large = account.rest > 0
                           ? kept(rows, [&](std::size_t, std::uint64_t) { return true; })
                           : without_small(rows, account, area, settings.threshold);
    factors.dropped = rows.column.size() - large.column.size();
    return close_account(std::move(large), outside.scaled, open, account.scale, factors.threads);
}

// The scaled counts; in place of those of the known sky, what has become of it.
void set_outside(const PairCounts& counts, double cell, const std::vector<double>& scale,
                 Factors& factors) {
    factors.outside.resize(counts.outside().size());
    for (std::size_t k = 0; k < factors.outside.size(); ++k) {
        const std::size_t i = k / counts.outsides();
        factors.outside[k] =
            scale[i] * (cell * static_cast<double>(counts.outside()[k])) / factors.nodes[i].area;
    }
}

void set_known_sky(const PairCounts& counts, const SkyShares& known, double loose,
                   const std::vector<double>& scale, Factors& factors) {
    double squares = 0, area = 0;
    for (std::size_t i = 0; i < factors.nodes.size(); ++i) {
        const double part = counts.exits()[i] > 0 ? scale[i] * loose : 0;
        const double sky = (1 - loose + part) * known.sky[i];
        factors.outside[i * counts.outsides()] = sky;
        const double error = known.error[i] + std::abs(sky - known.sky[i]);
        if (!factors.sky_error.empty())
            factors.outside_error[i * counts.outsides()] = factors.sky_error[i] = error;
        squares += factors.nodes[i].area * error * error;
        area += factors.nodes[i].area;
    }
    if (!factors.sky_error.empty())
        factors.rms_sky = std::sqrt(squares / area);
    factors.sky_from_points = true;
}

}  // namespace

void set_exchange(const PairCounts& counts, SparseRows rows, const std::optional<SkyShares>& known,
                  const FactorSettings& settings, Factors& factors) {
    const std::vector<double> area = areas_of(factors.nodes);
    // n_i = D A_i / (2 δ²): a line stands for so much of an exchange area.
    const double cell = 2 * factors.line_spacing * factors.line_spacing /
                        static_cast<double>(factors.bundles * PairCounts::line);
    for (double& value : rows.value)
        value *= cell;
    Account account;
    double loose = 1;
    if (known) {
        for (loose = 1e-4; loose < 1 && !account.closed; loose *= 100)
            account = close_rows(SparseRows(rows), outside_of(counts, cell, area, known, loose),
                                 area, settings, factors);
        loose /= 100;
    }
    if (!account.closed) {
        loose = 1;
        account = close_rows(std::move(rows), outside_of(counts, cell, area, known, loose), area,
                             settings, factors);
    }
    set_outside(counts, cell, account.scale, factors);
    if (known)
        set_known_sky(counts, *known, loose, account.scale, factors);
    factors.rest = account.rest;
    factors.start = std::move(account.exchange.start);
    factors.column = std::move(account.exchange.column);
    factors.exchange = std::move(account.exchange.value);
}

}  // namespace parallux
