#include "efficiency/gains.h"

#include <cmath>

namespace parallux::efficiency {

namespace {

double product(const Row& row) {
    return row.quadratic_error * row.seconds;
}

double product_at(const std::vector<const Row*>& curve, double seconds) {
    for (std::size_t k = 1; k < curve.size(); ++k) {
        const Row &a = *curve[k - 1], &b = *curve[k];
        if (seconds < a.seconds || seconds > b.seconds || !(b.seconds > a.seconds))
            continue;
        const double way = std::log(seconds / a.seconds) / std::log(b.seconds / a.seconds);
        return product(a) * std::pow(product(b) / product(a), way);
    }
    return product(seconds < curve.front()->seconds ? *curve.front() : *curve.back());
}

}  // namespace

std::vector<const Row*> rows_of(const std::vector<Row>& rows, const std::string& method) {
    std::vector<const Row*> found;
    for (const Row& row : rows)
        if (row.method == method)
            found.push_back(&row);
    return found;
}

void set_gains(std::vector<Row>& rows) {
    const std::vector<const Row*> paper = rows_of(rows, baseline);
    for (Row& row : rows)
        row.gain = row.method == baseline ? 1 : product_at(paper, row.seconds) / product(row);
}

}  // namespace parallux::efficiency
