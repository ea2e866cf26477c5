#include "solve/follow_groups.h"

#include <utility>

#include "parallel.h"

namespace parallux {

GroupSystem::GroupSystem(GroupWays ways, std::vector<double> reflectance, std::uint32_t bands,
                         unsigned threads)
    : ways_(std::move(ways)), reflectance_(std::move(reflectance)), bands_(bands), factors_(bands) {
    parallel_for(threads, bands, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t band = begin; band < end; ++band)
            factors_[band].compute(matrix(static_cast<std::uint32_t>(band)));
    });
}

// Symmetric, and positive definite where 0 < ρ < 1.
Eigen::MatrixXd GroupSystem::matrix(std::uint32_t band) const {
    const std::uint32_t n = ways_.groups;
    Eigen::MatrixXd matrix(n, n);
    for (std::uint32_t from = 0; from < n; ++from) {
        const double sent = reflectance_[from * bands_ + band];
        for (std::uint32_t to = 0; to < n; ++to)
            matrix(to, from) =
                -sent * reflectance_[to * bands_ + band] * ways_.lines[from * std::size_t(n) + to];
        matrix(from, from) += sent * ways_.exits[from];
        if (!(matrix(from, from) > 0))
            matrix(from, from) = 1;  // black, or no line leaves it
    }
    return matrix;
}

std::vector<double> GroupSystem::follow(const std::vector<double>& unshot) const {
    const Eigen::Index n = ways_.groups;
    std::vector<double> received(unshot.size());
    Eigen::MatrixXd lines(n, n);
    for (Eigen::Index k = 0; k < n * n; ++k)
        lines.data()[k] = ways_.lines[static_cast<std::size_t>(k)];
    for (std::uint32_t band = 0; band < bands_; ++band) {
        // What a line carries: u / n at first, ρ h later.
        Eigen::VectorXd carried(n), reflectance(n);
        for (Eigen::Index group = 0; group < n; ++group) {
            const auto k = static_cast<std::size_t>(group) * bands_ + band;
            const double exits = ways_.exits[static_cast<std::size_t>(group)];
            carried[group] = exits > 0 ? unshot[k] / exits : 0;
            reflectance[group] = reflectance_[k];
        }
        Eigen::VectorXd h = reflectance.cwiseProduct(lines * carried);
        solve(band, h);
        carried += reflectance.cwiseProduct(h);
        const Eigen::VectorXd all = lines * carried;
        for (Eigen::Index group = 0; group < n; ++group)
            received[static_cast<std::size_t>(group) * bands_ + band] = all[group];
    }
    return received;
}

}  // namespace parallux
