#include "reference/matrix.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/IterativeLinearSolvers>

#include "lines/line_stream.h"
#include "solve/bicgstab.h"

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

struct CountedLines::Matrix {
    Counts counts;
};

CountedLines::CountedLines(const Scene& scene, const Patches& patches)
    : scene_(scene),
      patches_(patches),
      between_(std::make_unique<Matrix>()),
      exits_(patches.count(), 0),
      escaped_(patches.count(), 0),
      sky_(patches.count() * patches.bands, 0) {
    const auto n = static_cast<Eigen::Index>(patches.count());
    between_->counts = Counts::Zero(n, n);
}

CountedLines::~CountedLines() = default;

void CountedLines::count(const IntersectionLists& lists,
                         const std::vector<glm::dvec3>& directions) {
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

void CountedLines::leave(std::uint32_t patch, const glm::dvec3* direction, double sign) {
    if (patch == none)
        return;
    ++exits_[patch];
    ++escaped_[patch];
    if (!direction)
        return;
    Spectrum radiance = scene_.sky.radiance(sign * *direction);
    for (std::uint32_t band = 0; band < patches_.bands; ++band)
        sky_[patch * std::size_t(patches_.bands) + band] += pi * radiance[band];
}

void CountedLines::pair(std::uint32_t i, std::uint32_t j) {
    if (i != none && j != none) {
        ++counts_.transfers;
        ++exits_[i];
        ++exits_[j];
        ++between_->counts(i, j);
        ++between_->counts(j, i);
    } else if (std::uint32_t patch = i != none ? i : j; patch != none) {
        leave(patch, nullptr, 0);
        ++counts_.met_backs;
    }
}

double CountedLines::escaped(std::size_t patch) const {
    return static_cast<double>(escaped_[patch]) / std::max(1.0, static_cast<double>(exits_[patch]));
}

double CountedLines::sky(std::size_t patch, std::uint32_t band) const {
    return sky_[patch * patches_.bands + band] / std::max(1.0, static_cast<double>(exits_[patch]));
}

// Light that goes through surfaces leaves no symmetric system: n H - N S H = N E + sky.
std::vector<double> CountedLines::irradiance_through(const std::vector<double>& emission,
                                                     const Vector& sky, const Vector& exits,
                                                     std::uint32_t band) const {
    const Eigen::Index n = exits.size();
    auto arriving = [&](const std::vector<double>& sent) {
        return counted(between_->counts, Eigen::Map<const Vector>(sent.data(), n));
    };
    auto times = [&](const std::vector<double>& irradiance) {
        std::vector<double> sent(irradiance.size());
        for (std::size_t patch = 0; patch < sent.size(); ++patch)
            sent[patch] = scattered(patches_, patch * patches_.bands + band, [&](std::size_t at) {
                return irradiance[at / patches_.bands];
            });
        const Vector result =
            Eigen::Map<const Vector>(irradiance.data(), n) - arriving(sent).cwiseQuotient(exits);
        return std::vector<double>(result.data(), result.data() + n);
    };
    const Vector first = (arriving(emission) + sky).cwiseQuotient(exits);
    return bicgstab(times, {first.data(), first.data() + n}, 10000,
                    [](const std::vector<double>&, double left) { return left <= 1e-13; });
}

std::vector<double> CountedLines::irradiance(const std::vector<double>& emission,
                                             std::uint32_t band) const {
    const Counts& between = between_->counts;
    const Eigen::Index n = between.rows();
    Vector exits(n), reflectance(n), sky(n);
    for (std::size_t patch = 0; patch < patches_.count(); ++patch) {
        const auto i = static_cast<Eigen::Index>(patch);
        exits[i] = std::max(1.0, static_cast<double>(exits_[patch]));
        reflectance[i] = patches_.reflectance[patch * patches_.bands + band];
        sky[i] = sky_[patch * patches_.bands + band];
    }
    if (patches_.translucent())
        return irradiance_through(emission, sky, exits, band);
    const Vector scale = (reflectance.cwiseQuotient(exits)).cwiseSqrt();
    const System system(between, scale);
    Eigen::ConjugateGradient<System, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner> cg;
    cg.setTolerance(1e-13);
    cg.compute(system);
    const Vector right = counted(between, Eigen::Map<const Vector>(emission.data(), n)) + sky;
    const Vector x = cg.solve(scale.cwiseProduct(right));
    // ρ_j H_j = √(ρ_j / n_j) x_j, and H by one more product, so that ρ = 0 needs no division.
    const Vector result = (right + counted(between, scale.cwiseProduct(x))).cwiseQuotient(exits);
    return {result.data(), result.data() + n};
}

std::uint64_t matrix_bytes(std::uint64_t patches) {
    return patches * patches * sizeof(std::uint32_t);
}

PassResult matrix_pass(const Run& run, DirectLight& direct, TransferState& state) {
    const std::uint32_t bands = state.bands;
    settle(run, direct);
    PassResult result;

    // Count the lines.
    CountedLines counted_lines(run.scene, run.patches);
    LineStream stream{*run.rays,
                      run.scene,
                      run.patches,
                      run.plan.sphere,
                      run.settings.seed,
                      run.plan.lines,
                      run.scene.sky.kind != Sky::Kind::dark,
                      run.plan.threads};
    const double lines = static_cast<double>(run.plan.lines);
    std::uint64_t done = trace_in_order(
        stream, [&](const IntersectionLists& lists, const std::vector<glm::dvec3>& directions,
                    std::uint64_t before) {
            counted_lines.count(lists, directions);
            std::uint64_t so_far = before + lists.lines();
            return run.listener.go_on("lines", static_cast<double>(so_far) / lines, so_far);
        });
    result.counts = counted_lines.counts();
    result.whole = done == run.plan.lines;
    const std::vector<std::uint64_t>& exits = counted_lines.exits();
    for (std::size_t patch = 0; patch < exits.size(); ++patch)
        run.banks.of(0).received[patch * lanes(bands) + bands] +=
            static_cast<std::int64_t>(exits[patch]);
    if (auto unseen = std::count(exits.begin(), exits.end(), 0u); unseen > 0)
        result.warnings.push_back(std::to_string(unseen) +
                                  " patches were left by no line and stay dark");

    // Solve each band, and say where its power went: all that was reflected has been sent on.
    Emission exitance = emission_of(run.patches, direct);
    exitance.quanta = 1;
    for (std::uint32_t band = 0; band < bands; ++band) {
        std::vector<double> emission(run.patches.count());
        for (std::size_t patch = 0; patch < emission.size(); ++patch)
            emission[patch] = exitance.of_exit(run.patches, patch * bands + band);
        const std::vector<double> irradiance = counted_lines.irradiance(emission, band);
        for (std::size_t patch = 0; patch < emission.size(); ++patch) {
            std::size_t k = patch * bands + band;
            double quanta = run.patches.area[patch] / state.watts_per_quantum;
            auto received = [&](std::size_t at) {
                const std::size_t side = at / bands;
                return std::llrint(irradiance[side] * run.patches.area[side] /
                                   state.watts_per_quantum);
            };
            const std::int64_t reflected = scattered_quanta(run.patches, k, received);
            run.banks.receive(0, k, received(k));
            state.sent[k] = reflected;
            state.absorbed[band] += received(k) - passed_on(run.patches, k, received(k));
            state.escaped[band] +=
                std::llrint((emission[patch] * quanta + static_cast<double>(reflected)) *
                            counted_lines.escaped(patch));
            state.sky[band] += std::llrint(counted_lines.sky(patch, band) * quanta);
        }
        state.emitted[band] = state.absorbed[band] + state.escaped[band] - state.sky[band];
    }
    return result;
}

}  // namespace parallux
