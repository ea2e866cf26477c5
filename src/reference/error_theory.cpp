#include "reference/error_theory.h"

#include <Eigen/LU>
#include <cmath>

namespace parallux {

using Eigen::MatrixXd;
using Eigen::VectorXd;

PredictedError error_theory(const ErrorModel& model) {
    const Eigen::Index n = model.area.size();
    const MatrixXd& f = model.factors;
    const VectorXd& rho = model.reflectance;
    const MatrixXd identity = MatrixXd::Identity(n, n);

    // The mean field: B = E + ρ H, H = F B.
    const VectorXd radiosity =
        (identity - rho.asDiagonal() * f).partialPivLu().solve(model.emission);
    const VectorXd irradiance = f * radiosity;

    // β = source + ρ² F β.
    const VectorXd reflected = rho.cwiseProduct(irradiance);
    VectorXd source =
        model.emission.array().square() + 2 * model.emission.array() * reflected.array();
    if (model.direction == Direction::oriented)
        source.array() += 2 * reflected.array().square();
    const VectorXd rho_squared = rho.array().square();
    const VectorXd beta = (identity - rho_squared.asDiagonal() * f).partialPivLu().solve(source);

    PredictedError predicted;
    const VectorXd variance = rho_squared.cwiseProduct(f * beta).cwiseQuotient(model.exits);
    predicted.quadratic = model.area.dot(variance) / model.area.sum();

    // Cov[B] = A⁻¹ {G D_ρ Σ_m D_ρ Gᵀ + (G - I) diag(Φ²/n) (G - I)ᵀ} A⁻¹, G = (I - D_ρ Fᵀ)⁻¹,
    // Σ_m = Σ_i (A_i² β_i / n_i) [diag(F_i·) - F_i·ᵀ F_i·].
    const VectorXd weight = model.area.array().square() * beta.array() / model.exits.array();
    MatrixXd moments = -(f.transpose() * weight.asDiagonal() * f);
    moments.diagonal() += f.transpose() * weight;
    const MatrixXd green = (identity - rho.asDiagonal() * f.transpose()).partialPivLu().inverse();
    const VectorXd emitted =
        (model.area.array() * model.emission.array()).square() / model.exits.array();
    const MatrixXd through = green * rho.asDiagonal();
    const MatrixXd later = green - identity;
    MatrixXd covariance =
        through * moments * through.transpose() + later * emitted.asDiagonal() * later.transpose();
    // Weighted by area on either side: Σ A_i (ΔB_i)² / Σ A_i is a sum of squares of this.
    const VectorXd root = model.area.array().rsqrt() / std::sqrt(model.area.sum());
    covariance = root.asDiagonal() * covariance * root.asDiagonal();
    predicted.quadratic_full = covariance.trace();
    predicted.freedom = std::pow(covariance.trace(), 2) / covariance.squaredNorm();
    predicted.variation = std::sqrt(2 / predicted.freedom);
    return predicted;
}

}  // namespace parallux
