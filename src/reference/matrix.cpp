#include "reference/matrix.h"

#include <cmath>

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>

#include "lines/line_stream.h"

namespace parallux {

namespace {

using Counts = Eigen::Matrix<std::uint32_t, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::VectorXd;

class System;

}  // namespace

}  // namespace parallux

// Eigen asks for this of an operator without a stored matrix.
template <>
struct Eigen::internal::traits<parallux::System>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace parallux {

namespace {

// I - T N T with T = diag(√(ρ_i / n_i)): H = F (E + ρ H) in the unknowns √(n_i ρ_i) H_i.
class System : public Eigen::EigenBase<System> {
public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum {
        ColsAtCompileTime = Eigen::Dynamic,
        MaxColsAtCompileTime = Eigen::Dynamic,
        IsRowMajor = false
    };

    System(const Counts& counts, Vector scale) : counts_(counts), scale_(std::move(scale)) {}

    Eigen::Index rows() const { return counts_.rows(); }
    Eigen::Index cols() const { return counts_.cols(); }
    template <class Right>
    Eigen::Product<System, Right, Eigen::AliasFreeProduct> operator*(
        const Eigen::MatrixBase<Right>& x) const {
        return {*this, x.derived()};
    }
    Vector times(const Vector& x) const;

private:
    const Counts& counts_;
    Vector scale_;
};

// Σ_j n_ij x_j, column by column: columns are rows, and no double copy of the counts is made.
Vector counted(const Counts& counts, const Vector& x) {
    Vector sum = Vector::Zero(x.size());
    for (Eigen::Index j = 0; j < counts.cols(); ++j)
        if (x[j] != 0)
            sum.noalias() += x[j] * counts.col(j).cast<double>();
    return sum;
}

Vector System::times(const Vector& x) const {
    return x - scale_.cwiseProduct(counted(counts_, scale_.cwiseProduct(x)));
}

}  // namespace

}  // namespace parallux

template <class Right>
struct Eigen::internal::generic_product_impl<parallux::System, Right, Eigen::SparseShape,
                                             Eigen::DenseShape, Eigen::GemvProduct>
    : generic_product_impl_base<parallux::System, Right,
                                generic_product_impl<parallux::System, Right>> {
    template <class Result>
    static void scaleAndAddTo(Result& result, const parallux::System& system, const Right& x,
                              const double& factor) {
        result += factor * system.times(x);
    }
};

namespace parallux {

namespace {

// What the lines counted.
struct Counted {
    Counts between;
    std::vector<std::uint64_t> escaped;  // exits that ended outside or at a back
    std::vector<double> sky;             // Σ π L over the exits that met the sky; band by patch
};

class Counter {
public:
    Counter(const Run& run, TransferState& state, LineCounts& counts, Counted& counted)
        : run_(run), state_(state), counts_(counts), counted_(counted) {}

    void count(const IntersectionLists& lists, const std::vector<glm::dvec3>& directions) {
        counts_.lines += lists.lines();
        counts_.hits += lists.hits.size();
        for (std::size_t line = 0; line < lists.lines(); ++line) {
            std::uint32_t first = lists.start[line], end = lists.start[line + 1];
            if (first == end)
                continue;
            ++counts_.nonempty;
            counts_.odd += (end - first) % 2;
            const glm::dvec3* direction = directions.empty() ? nullptr : &directions[line];
            leave(lists.hits[first].toward, direction, -1);
            leave(lists.hits[end - 1].away, direction, 1);
            for (std::uint32_t k = first; k + 1 < end; ++k)
                pair(lists.hits[k].away, lists.hits[k + 1].toward);
        }
    }

private:
    void leave(std::uint32_t patch, const glm::dvec3* direction, double sign) {
        if (patch == none)
            return;
        ++state_.exits[patch];
        ++counted_.escaped[patch];
        if (!direction)
            return;
        Spectrum radiance = run_.scene.sky.radiance(sign * *direction);
        for (std::uint32_t band = 0; band < state_.bands; ++band)
            counted_.sky[patch * std::size_t(state_.bands) + band] += pi * radiance[band];
    }

    void pair(std::uint32_t i, std::uint32_t j) {
        if (i != none && j != none) {
            ++counts_.transfers;
            ++state_.exits[i];
            ++state_.exits[j];
            ++counted_.between(i, j);
            ++counted_.between(j, i);
        } else if (std::uint32_t patch = i != none ? i : j; patch != none) {
            leave(patch, nullptr, 0);
            ++counts_.met_backs;
        }
    }

    const Run& run_;
    TransferState& state_;
    LineCounts& counts_;
    Counted& counted_;
};

// Irradiance of one band, W/m².
Vector solve_band(const Run& run, const TransferState& state, const Counted& counted_lines,
                  const Vector& emission, std::uint32_t band) {
    const Eigen::Index n = counted_lines.between.rows();
    const std::uint32_t bands = state.bands;
    Vector exits(n), reflectance(n), sky(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        std::size_t k = static_cast<std::size_t>(i) * bands + band;
        exits[i] = std::max(1.0, static_cast<double>(state.exits[static_cast<std::size_t>(i)]));
        reflectance[i] = run.patches.reflectance[k];
        sky[i] = counted_lines.sky[k];
    }
    const Vector scale = (reflectance.cwiseQuotient(exits)).cwiseSqrt();
    const System system(counted_lines.between, scale);
    Eigen::ConjugateGradient<System, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner> cg;
    cg.setTolerance(1e-13);
    cg.compute(system);
    const Vector right = counted(counted_lines.between, emission) + sky;
    const Vector x = cg.solve(scale.cwiseProduct(right));
    // ρ_j H_j = √(ρ_j / n_j) x_j, and H by one more product, so that ρ = 0 needs no division.
    return (right + counted(counted_lines.between, scale.cwiseProduct(x))).cwiseQuotient(exits);
}

}  // namespace

std::uint64_t matrix_bytes(std::uint64_t patches) {
    return patches * patches * sizeof(std::uint32_t);
}

PassResult matrix_pass(const Run& run, const DirectLight& direct, TransferState& state) {
    const std::uint32_t bands = state.bands;
    const auto n = static_cast<Eigen::Index>(run.patches.count());
    PassResult result;

    // Count the lines.
    Counted counted_lines;
    counted_lines.between = Counts::Zero(n, n);
    counted_lines.escaped.assign(run.patches.count(), 0);
    counted_lines.sky.assign(run.patches.count() * bands, 0);
    Counter counter(run, state, result.counts, counted_lines);
    LineStream stream{*run.rays,
                      run.scene,
                      run.patches,
                      run.plan.sphere,
                      run.settings.seed,
                      run.plan.lines,
                      run.scene.sky.kind != Sky::Kind::dark,
                      run.plan.threads};
    std::uint64_t done = trace_in_order(stream, [&](const IntersectionLists& lists,
                                                    const std::vector<glm::dvec3>& directions,
                                                    std::uint64_t) {
        counter.count(lists, directions);
        return run.listener.go_on(
            "lines", static_cast<double>(result.counts.lines) / static_cast<double>(run.plan.lines),
            result.counts.lines);
    });
    result.whole = done == run.plan.lines;
    std::size_t unseen = 0;
    for (std::uint64_t exits : state.exits)
        unseen += exits == 0;
    if (unseen > 0)
        result.warnings.push_back(std::to_string(unseen) +
                                  " patches were left by no line and stay dark");

    // Solve each band, and say where its power went.
    for (std::uint32_t band = 0; band < bands; ++band) {
        Vector emission(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            auto patch = static_cast<std::size_t>(i);
            emission[i] = static_cast<double>(direct.unshot[patch * bands + band]) *
                          state.watts_per_quantum / run.patches.area[patch];
        }
        const Vector irradiance = solve_band(run, state, counted_lines, emission, band);
        for (Eigen::Index i = 0; i < n; ++i) {
            auto patch = static_cast<std::size_t>(i);
            std::size_t k = patch * bands + band;
            double quanta = run.patches.area[patch] / state.watts_per_quantum;
            double exits = std::max(1.0, static_cast<double>(state.exits[patch]));
            state.received[k] = std::llrint(irradiance[i] * quanta);
            std::int64_t reflected = std::llrint(static_cast<double>(run.patches.reflectance[k]) *
                                                 static_cast<double>(state.received[k]));
            state.absorbed[band] += state.received[k] - reflected;
            state.escaped[band] +=
                std::llrint((emission[i] * quanta + static_cast<double>(reflected)) *
                            static_cast<double>(counted_lines.escaped[patch]) / exits);
            state.sky[band] += std::llrint(counted_lines.sky[k] / exits * quanta);
        }
        state.emitted[band] = state.absorbed[band] + state.escaped[band] - state.sky[band];
    }
    return result;
}

}  // namespace parallux
