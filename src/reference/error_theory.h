#pragma once

#include <Eigen/Core>

#include "parallux/transfer.h"

namespace parallux {

/// What the theory needs of a scene, one band; vectors and matrices over patches.
struct ErrorModel {
    Eigen::MatrixXd factors;   ///< F_ij
    Eigen::VectorXd area;      ///< m²
    Eigen::VectorXd emission;  ///< of the pass: ρ H_direct after a first shot, W/m²
    Eigen::VectorXd reflectance;
    Eigen::VectorXd exits;  ///< expected lines that leave each patch, n_i
    Direction direction = Direction::bidirectional;
};

/// The error of the global algorithm over independent lines, before any line is cast.
struct PredictedError {
    /// Area-weighted mean of V[B_j] = ρ_j² Σ_i F_ji β_i / n_j, where β_i is the second moment of
    /// the power that an exit carries: bidirectional E² + 2 E ρ H + ρ² F β, oriented 2 ρ² H² more.
    double quadratic = 0;
    /// The same from the trace of the full covariance, which also knows that counts add up.
    double quadratic_full = 0;
    /// (tr C)² / tr C², C the covariance in √area: the χ² that a run's quadratic error resembles
    /// has so many degrees of freedom, and a coefficient of variation of √(2 / ν).
    double freedom = 0;
    double variation = 0;
};

/// Takes O(n³): for some hundred patches. predict_error() in parallux/predict.h estimates
/// `quadratic` for any scene.
PredictedError error_theory(const ErrorModel& model);

}  // namespace parallux
