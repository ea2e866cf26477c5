#include "solve/bicgstab.h"

#include <cmath>
#include <cstddef>

namespace parallux {

namespace {

using Values = std::vector<double>;

double dot(const Values& a, const Values& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += a[k] * b[k];
    return sum;
}

// a + s b
Values plus(Values a, double s, const Values& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
        a[k] += s * b[k];
    return a;
}

}  // namespace

Values bicgstab(const std::function<Values(const Values&)>& times, const Values& b, int steps,
                const std::function<bool(const Values&, double)>& over) {
    Values x(b.size(), 0), best = x, residual = b, search = b;
    const Values shadow = b;
    double rho = dot(shadow, residual), least = rho;
    const double all = rho;
    for (int step = 0; step < steps && least > 0; ++step) {
        const Values v = times(search);
        const double alpha = rho / dot(shadow, v);
        const Values half = plus(residual, -alpha, v), t = times(half);
        const double squares = dot(t, t), omega = squares > 0 ? dot(t, half) / squares : 0;
        x = plus(plus(std::move(x), alpha, search), omega, half);
        residual = plus(half, -omega, t);
        const double left = dot(residual, residual);
        if (!std::isfinite(left))
            break;
        if (left < least) {
            least = left;
            best = x;
        }
        if (over(x, std::sqrt(left / all)))
            return x;
        const double next = dot(shadow, residual);
        search = plus(residual, next / rho * alpha / omega, plus(search, -omega, v));
        rho = next;
    }
    return best;
}

}  // namespace parallux
