#include <algorithm>
#include <cmath>

#include "parallux/factors.h"

namespace parallux {

namespace {

// The stored exchange_ji; 0 where there is none.
double stored(const Factors& factors, std::uint32_t row, std::uint32_t column) {
    const auto begin = factors.column.begin() + static_cast<std::ptrdiff_t>(factors.start[row]);
    const auto end = factors.column.begin() + static_cast<std::ptrdiff_t>(factors.start[row + 1]);
    const auto found = std::lower_bound(begin, end, column);
    return found != end && *found == column
               ? factors.exchange[static_cast<std::size_t>(found - factors.column.begin())]
               : 0;
}

}  // namespace

FactorCheck check_factors(const Factors& factors) {
    FactorCheck check;
    check.smallest = 1;
    const std::size_t outsides = factors.outsides();
    for (std::uint32_t i = 0; i < factors.nodes.size(); ++i) {
        double sum = 0;
        for (std::uint64_t k = factors.start[i]; k < factors.start[i + 1]; ++k) {
            const double factor = factors.exchange[k] / factors.nodes[i].area;
            sum += factor;
            check.smallest = std::min(check.smallest, factor);
            check.reciprocity =
                std::max(check.reciprocity,
                         std::abs(factors.exchange[k] - stored(factors, factors.column[k], i)));
        }
        for (std::size_t k = i * outsides; k < (i + 1) * outsides; ++k) {
            sum += factors.outside[k];
            check.smallest = std::min(check.smallest, factors.outside[k]);
        }
        check.row_deviation = std::max(check.row_deviation, std::abs(sum - 1));
    }
    return check;
}

}  // namespace parallux
