#pragma once

#include <Eigen/Core>

#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux {

/// F_ij between all pairs of patches in closed form, for rooms where nothing stands between any two
/// points (convex enclosures): nobody looks for occluders. 8 n² bytes, n² / 2 closed forms.
Eigen::MatrixXd exact_factors(const Scene& scene, const Patches& patches, unsigned threads = 0);

/// Radiosity of one band from B = E + S F B, by LU decomposition; S as scattering_of() has it.
Eigen::VectorXd exact_radiosity(const Eigen::MatrixXd& factors, const Patches& patches,
                                std::uint32_t band = 0);

/// The emission of a band as a vector; the reflectance likewise.
Eigen::VectorXd emission_of(const Patches& patches, std::uint32_t band = 0);
Eigen::VectorXd reflectance_of(const Patches& patches, std::uint32_t band = 0);

/// S of one band: ρ_i where j is i, τ_j where j is the other side of i. 8 n² bytes.
Eigen::MatrixXd scattering_of(const Patches& patches, std::uint32_t band = 0);

}  // namespace parallux
