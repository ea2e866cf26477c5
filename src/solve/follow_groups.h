#pragma once

#include <vector>

#include <Eigen/Cholesky>

#include "solve/ways.h"

namespace parallux {

/// x = P (u + ρ x) between few groups: the power that each receives of unshot power u over all
/// bounces, P the share of what leaves each that comes to each. Solved whole (Cholesky), as light
/// that is held for long is even within a group. Arrays group · bands + band.
class GroupSystem {
public:
    /// O(groups³ bands), on as many threads as there are bands.
    GroupSystem(GroupWays ways, std::vector<double> reflectance, std::uint32_t bands,
                unsigned threads);

    /// All power is absorbed or leaves the scene, but that of groups that no line leaves: that is
    /// dropped. O(groups² bands).
    std::vector<double> follow(const std::vector<double>& unshot) const;

    const GroupWays& ways() const { return ways_; }
    /// (R (n - N R))⁻¹ s of one band, in place: R reflectances, n exits, N lines between.
    void solve(std::uint32_t band, Eigen::VectorXd& s) const { factors_[band].solveInPlace(s); }

private:
    Eigen::MatrixXd matrix(std::uint32_t band) const;

    GroupWays ways_;
    std::vector<double> reflectance_;
    std::uint32_t bands_;
    std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
};

}  // namespace parallux
