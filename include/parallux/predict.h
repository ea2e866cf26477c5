#pragma once

#include "parallux/patches.h"
#include "parallux/scene.h"
#include "parallux/solve.h"

// Before the lines: how wrong a number of them will be.

namespace parallux {

/// Expected error of the global algorithm over independent lines (--method lines), and so of
/// bundles of random directions with at most a line a patch; shuffled lattice directions do several
/// times better. All bands together.
struct Prediction {
    double error_times_lines = 0;  ///< quadratic error × lines, (W/m²)²
    double mean_square = 0;        ///< area-weighted mean of B², (W/m²)²

    /// Expected quadratic error, the area-weighted mean of (B - B*)², after so many lines.
    double quadratic(double lines) const { return error_times_lines / lines; }
    /// Relative RMS error that a quadratic error means.
    double relative(double quadratic) const;
    /// Lines for a relative RMS error.
    double lines_for(double relative_rms) const;
};

/// V[B_j] = ρ_j² Σ_i F_ji β_i / n_j, with n_j the expected exits of patch j and β_i the second
/// moment of the power an exit carries: E² + 2 E ρ H + ρ² F β, oriented 2 ρ² H² more. β is itself a
/// radiosity, of reflectance ρ² and another emission, and is solved for by a few bundles. Of the
/// settings count direction, first_shot (off, or any other: E is then ρ H_direct), sphere_radius,
/// seed, threads, max_memory. Costs three or four solves of 512 bundles.
Prediction predict_error(const Scene& scene, const Patches& patches, const SolveSettings& settings);

}  // namespace parallux
