#include "solve/follow.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallux/scene.h"
#include "solve/settled.h"

namespace parallux {

namespace {

constexpr int most_steps = 500;

using Values = std::vector<double>;
using Sums = std::array<double, max_bands>;

// Of bands that are solved side by side.
Sums products(const Values& a, const Values& b, std::uint32_t bands) {
    Sums sums{};
    for (std::size_t k = 0; k < a.size(); k += bands)
        for (std::uint32_t band = 0; band < bands; ++band)
            sums[band] += a[k + band] * b[k + band];
    return sums;
}

// 1 - T N T in y = √(ρ / n) x, with N the lines between regions, n those that leave each and T =
// diag(√(ρ / n)): symmetric, and positive definite where ρ < 1.
class System {
public:
    System(const RegionWays& ways, const Values& reflectance, std::uint32_t bands, unsigned threads)
        : ways_(ways), scale_(reflectance), bands_(bands), threads_(threads) {
        for (std::size_t k = 0; k < scale_.size(); ++k) {
            const double exits = ways.exits[k / bands];
            scale_[k] = exits > 0 ? std::sqrt(reflectance[k] / exits) : 0;
        }
    }

    std::uint32_t bands() const { return bands_; }
    const Values& scale() const { return scale_; }
    Values neighbours(const Values& values) const {
        Values sums(values.size(), 0);
        ways_.add_neighbours(values, bands_, threads_, sums);
        return sums;
    }
    Values scaled(Values values) const {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] *= scale_[k];
        return values;
    }
    // n T y: what regions reflect of what they are to receive.
    Values reflected(Values y) const {
        for (std::size_t k = 0; k < y.size(); ++k)
            y[k] *= scale_[k] * ways_.exits[k / bands_];
        return y;
    }
    Values times(const Values& y) const {
        Values result = scaled(neighbours(scaled(y)));
        for (std::size_t k = 0; k < y.size(); ++k)
            result[k] = y[k] - result[k];
        return result;
    }

private:
    const RegionWays& ways_;
    Values scale_;
    std::uint32_t bands_;
    unsigned threads_;
};

// Z (Zᵀ A Z)⁻¹ Zᵀ with Z = √(ρ n) within each group: irradiances that are even in it.
class Lead {
public:
    Lead(const RegionWays& ways, const Values& reflectance, std::uint32_t bands,
         const std::vector<std::uint32_t>& group, const GroupSystem& groups)
        : group_(group), groups_(groups), bands_(bands), even_(reflectance) {
        for (std::size_t k = 0; k < even_.size(); ++k)
            even_[k] = std::sqrt(reflectance[k] * ways.exits[k / bands_]);
        for (std::uint32_t one : group)
            count_ = std::max<Eigen::Index>(count_, one + 1);
    }

    void add(const Values& residual, Values& to) const {
        for (std::uint32_t band = 0; band < bands_; ++band) {
            Eigen::VectorXd sums = Eigen::VectorXd::Zero(count_);
            for (std::size_t region = 0; region < group_.size(); ++region)
                sums[group_[region]] +=
                    even_[region * bands_ + band] * residual[region * bands_ + band];
            groups_.solve(band, sums);
            for (std::size_t region = 0; region < group_.size(); ++region)
                to[region * bands_ + band] += even_[region * bands_ + band] * sums[group_[region]];
        }
    }

private:
    const std::vector<std::uint32_t>& group_;
    const GroupSystem& groups_;
    std::uint32_t bands_;
    Eigen::Index count_ = 0;
    Values even_;
};

Values conjugate_gradients(const System& system, const Lead& lead, Values residual,
                           Settled& settled) {
    const std::uint32_t bands = system.bands();
    auto led = [&] {
        Values direction = residual;
        lead.add(residual, direction);
        return direction;
    };
    Values y(residual.size(), 0), search = led();
    Sums rest = products(residual, search, bands);
    for (int steps = 0; steps < most_steps && !settled.all_over(); ++steps) {
        const Values applied = system.times(search);
        const Sums bent = products(search, applied, bands);
        Sums step{};
        for (std::uint32_t band = 0; band < bands; ++band)
            step[band] = bent[band] > 0 && !settled.over(band) ? rest[band] / bent[band] : 0;
        for (std::size_t k = 0; k < y.size(); ++k) {
            y[k] += step[k % bands] * search[k];
            residual[k] -= step[k % bands] * applied[k];
        }
        const Values next = led();
        const Sums now = products(residual, next, bands);
        for (std::size_t k = 0; k < y.size(); ++k) {
            const double before = rest[k % bands];
            search[k] = next[k] + (before > 0 ? now[k % bands] / before : 0) * search[k];
        }
        rest = now;
        settled.step(system.reflected(y));
    }
    return y;
}

}  // namespace

std::vector<double> follow(const RegionWays& ways, const std::vector<double>& reflectance,
                           const std::vector<double>& unshot, const std::vector<double>& received,
                           std::uint32_t bands, const std::vector<std::uint32_t>& group,
                           const GroupSystem& groups, unsigned threads) {
    const System system(ways, reflectance, bands, threads);
    const Lead lead(ways, reflectance, bands, group, groups);
    // x = N (u / n + T y): one more product in the end, so that ρ = 0 needs no division.
    Values per_line = unshot;
    for (std::size_t k = 0; k < per_line.size(); ++k)
        per_line[k] = ways.exits[k / bands] > 0 ? unshot[k] / ways.exits[k / bands] : 0;
    const Values first = system.neighbours(per_line);
    Values known = received;
    for (std::size_t k = 0; k < known.size(); ++k)
        known[k] *= reflectance[k];
    Settled settled(known, group, bands);
    const Values y = conjugate_gradients(system, lead, system.scaled(first), settled);
    Values to_come = system.neighbours(system.scaled(y));
    for (std::size_t k = 0; k < to_come.size(); ++k)
        to_come[k] += first[k];
    return to_come;
}

}  // namespace parallux
