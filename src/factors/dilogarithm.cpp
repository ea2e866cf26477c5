#include "factors/dilogarithm.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "parallux/spectrum.h"

namespace parallux {

namespace {

constexpr std::size_t terms = 15;

// ζ(2n) of Riemann, n = 1 … 15.
constexpr std::array<double, terms> zeta{
    1.644934066848226436, 1.082323233711138192, 1.017343061984449140, 1.004077356197944339,
    1.000994575127818085, 1.000246086553308048, 1.000061248135058705, 1.000015282259408652,
    1.000003817293265000, 1.000000953962033873, 1.000000238450502728, 1.000000059608189051,
    1.000000014901554828, 1.000000003725334025, 1.000000000931327432};

// ζ(2n) / (n (2n + 1)), times 1 - 4⁻ⁿ for the series about π.
constexpr std::array<double, terms> coefficients(bool about_pi) {
    std::array<double, terms> result{};
    double power = 1;
    for (std::size_t k = 0; k < terms; ++k) {
        double n = static_cast<double>(k + 1);
        power /= 4;
        result[k] = zeta[k] / (n * (2 * n + 1)) * (about_pi ? 1 - power : 1);
    }
    return result;
}

constexpr std::array<double, terms> about_zero = coefficients(false), about_pi = coefficients(true);

// Σ c_n yⁿ, n = 1 … terms.
double series(const std::array<double, terms>& c, double y) {
    double sum = 0;
    for (std::size_t k = terms; k-- > 0;)
        sum = (sum + c[k]) * y;
    return sum;
}

}  // namespace

double clausen(double phi) {
    if (phi > pi)
        return -clausen(2 * pi - phi);
    if (phi <= 0)
        return 0;
    // The arguments of both series stay below 1/9.
    if (phi < 2 * pi / 3) {
        double y = phi / (2 * pi);
        return phi * (1 - std::log(phi) + series(about_zero, y * y));
    }
    double rest = pi - phi, y = rest / pi;
    return rest * (std::log(2.0) - series(about_pi, y * y));
}

double dilogarithm_sine(double x, double theta) {
    double size = std::exp(x);
    double omega = std::atan2(size * std::sin(theta), 1 - size * std::cos(theta));
    return omega * x + 0.5 * (clausen(2 * omega) - clausen(2 * theta + 2 * omega));
}

}  // namespace parallux
