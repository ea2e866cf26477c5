#include "view_factors/exchange_areas.h"

#include <algorithm>
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

}  // namespace

void set_exchange(const PairCounts& counts, SparseRows rows, const FactorSettings& settings,
                  Factors& factors) {
    const std::size_t n = factors.nodes.size();
    const std::vector<double> area = areas_of(factors.nodes);
    // n_i = D A_i / (2 δ²): a line stands for so much of an exchange area.
    const double cell = 2 * factors.line_spacing * factors.line_spacing /
                        static_cast<double>(factors.bundles * PairCounts::line);
    for (double& value : rows.value)
        value *= cell;
    std::vector<double> outside(n, 0);
    for (std::size_t k = 0; k < counts.outside().size(); ++k)
        outside[k / counts.outsides()] += cell * static_cast<double>(counts.outside()[k]);
    Account account;
    if (settings.threshold > 0) {
        account = close_account(rows, outside, area, {}, factors.threads);
        SparseRows large = account.rest > 0
                               ? kept(rows, [&](std::size_t, std::uint64_t) { return true; })
                               : without_small(rows, account, area, settings.threshold);
        factors.dropped = rows.column.size() - large.column.size();
        account = close_account(std::move(large), outside, area, account.scale, factors.threads);
    } else {
        account = close_account(std::move(rows), outside, area, {}, factors.threads);
    }
    factors.outside.resize(counts.outside().size());
    for (std::size_t k = 0; k < factors.outside.size(); ++k) {
        const std::size_t i = k / counts.outsides();
        factors.outside[k] =
            account.scale[i] * (cell * static_cast<double>(counts.outside()[k])) / area[i];
    }
    factors.rest = account.rest;
    factors.start = std::move(account.exchange.start);
    factors.column = std::move(account.exchange.column);
    factors.exchange = std::move(account.exchange.value);
}

}  // namespace parallux
