#include "view_factors/scale.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"

namespace parallux {

namespace {

using Vector = std::vector<double>;

constexpr double close_enough = 2e-14;  // of a row's area
constexpr int most_steps = 40;          // of Newton's method
constexpr int most_products = 400;      // of conjugate gradients in one of them

double dot(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

// The scales minimise ½ Σ_ij n_ij e^(x_i + x_j) + Σ_i s_i e^(x_i) - Σ_i A_i x_i with d = e^x: a
// convex function, whose gradient is row sums minus areas and whose Hessian is diag(row sums) + X.
class Scaling {
public:
    Scaling(const SparseRows& counts, const Vector& outside, const Vector& area, unsigned threads)
        : counts_(counts), outside_(outside), area_(area), threads_(threads) {
        for (Vector* v : {&row_, &missing_, &step_, &residual_, &search_, &image_, &weighted_})
            v->resize(area.size(), 0);
    }

    /// Improves the scales; true once all rows are closed.
    bool run(Vector& scale) {
        double best = 1e300;
        int worse = 0;
        for (int step = 0; step < most_steps && worse < 8; ++step) {
            const double deviation = sum_rows(scale);
            if (deviation <= close_enough || (deviation < 1e-12 && deviation >= 0.5 * best))
                return true;
            worse = deviation < 0.9 * best ? 0 : worse + 1;
            best = std::min(best, deviation);
            solve_step(scale, std::min(0.1, deviation));
            double longest = 1;
            for (double s : step_)
                longest = std::max(longest, std::abs(s));
            for (std::size_t i = 0; i < scale.size(); ++i)
                scale[i] *= std::exp(step_[i] / longest);
        }
        return sum_rows(scale) < 1e-12;
    }

private:
    // y = N x, without scales.
    void product(const Vector& x, Vector& y) const {
        parallel_for(threads_, x.size(), 512, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i) {
                double sum = 0;
                for (std::uint64_t k = counts_.start[i]; k < counts_.start[i + 1]; ++k)
                    sum += counts_.value[k] * x[counts_.column[k]];
                y[i] = sum;
            }
        });
    }

    // Row sums, what they lack, and the largest share of an area that is lacking; rows without
    // lines lack nothing that could be mended.
    double sum_rows(const Vector& scale) {
        product(scale, row_);
        double worst = 0;
        for (std::size_t i = 0; i < row_.size(); ++i) {
            row_[i] = scale[i] * (row_[i] + outside_[i]);
            missing_[i] = row_[i] > 0 ? area_[i] - row_[i] : 0;
            worst = std::max(worst, std::abs(missing_[i]) / area_[i]);
        }
        return worst;
    }

    // (diag(row) + d N d) step = missing, by conjugate gradients, preconditioned by the diagonal.
    void solve_step(const Vector& scale, double accuracy) {
        const std::size_t n = scale.size();
        std::fill(step_.begin(), step_.end(), 0);
        residual_ = missing_;
        Vector& conditioned = weighted_;
        auto condition = [&] {
            for (std::size_t i = 0; i < n; ++i)
                conditioned[i] = row_[i] > 0 ? residual_[i] / row_[i] : 0;
            return dot(conditioned, residual_);
        };
        double square = condition();
        const double enough = square * accuracy * accuracy;
        search_ = conditioned;
        for (int k = 0; k < most_products && square > enough; ++k) {
            for (std::size_t i = 0; i < n; ++i)
                conditioned[i] = scale[i] * search_[i];
            product(conditioned, image_);
            for (std::size_t i = 0; i < n; ++i)
                image_[i] = row_[i] * search_[i] + scale[i] * image_[i];
            const double curvature = dot(search_, image_);
            if (!(curvature > 0))
                return;
            const double length = square / curvature;
            for (std::size_t i = 0; i < n; ++i) {
                step_[i] += length * search_[i];
                residual_[i] -= length * image_[i];
            }
            const double before = square;
            square = condition();
            for (std::size_t i = 0; i < n; ++i)
                search_[i] = conditioned[i] + square / before * search_[i];
        }
    }

    const SparseRows& counts_;
    const Vector &outside_, &area_;
    unsigned threads_;
    Vector row_, missing_, step_, residual_, search_, image_, weighted_;
};

// One product for both triangles, so that they have the same bits.
void apply_scale(const Vector& scale, unsigned threads, SparseRows& rows) {
    parallel_for(threads, rows.rows(), 512, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::uint64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
                rows.value[k] *= scale[i] * scale[rows.column[k]];
    });
}

double row_sum(const SparseRows& rows, std::size_t i) {
    double sum = 0;
    for (std::uint64_t k = rows.start[i]; k < rows.start[i + 1]; ++k)
        sum += rows.value[k];
    return sum;
}

// Cuts rows above their area down, alike on both sides, and fills all up on the diagonal.
void force_closed(const Vector& area, Account& account) {
    const std::size_t n = area.size();
    Vector cut(n, 1), missing(n, 0);
    for (std::size_t i = 0; i < n; ++i)
        if (const double sum = row_sum(account.exchange, i) + account.outside[i]; sum > area[i])
            cut[i] = area[i] / sum;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::uint64_t k = account.exchange.start[i]; k < account.exchange.start[i + 1]; ++k)
            account.exchange.value[k] *= std::min(cut[i], cut[account.exchange.column[k]]);
        account.outside[i] *= cut[i];
        account.scale[i] *= cut[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
        missing[i] = std::max(0.0, area[i] - row_sum(account.exchange, i) - account.outside[i]);
        if (missing[i] < 1e-13 * area[i])
            missing[i] = 0;
        account.rest += missing[i];
    }
    add_to_diagonal(missing, account.exchange);
}

}  // namespace

Account close_account(SparseRows counts, const std::vector<double>& outside,
                      const std::vector<double>& area, const std::vector<double>& scale,
                      unsigned threads) {
    Account account;
    account.scale = scale.empty() ? Vector(area.size(), 1) : scale;
    bool closed = Scaling(counts, outside, area, threads).run(account.scale);
    // A scaling that has run away is of no use.
    for (double& d : account.scale)
        if (!std::isfinite(d) || d > 1e3 || d < 1e-3) {
            d = 1;
            closed = false;
        }
    account.outside.resize(area.size());
    bool empty = false;
    for (std::size_t i = 0; i < area.size(); ++i) {
        account.outside[i] = account.scale[i] * outside[i];
        empty |= counts.start[i] == counts.start[i + 1] && outside[i] == 0;
    }
    account.closed = closed;
    account.exchange = std::move(counts);
    apply_scale(account.scale, threads, account.exchange);
    if (!closed || empty)
        force_closed(area, account);
    return account;
}

}  // namespace parallux
