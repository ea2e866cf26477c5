#pragma once

#include <Eigen/Core>

#include "parallux/patches.h"
#include "parallux/scene.h"

namespace parallux {

/// F_ij between all pairs of patches in closed form, for rooms where nothing stands between any two
/// points (convex enclosures): nobody looks for occluders. 8 n² bytes, n² / 2 closed forms.
Eigen::MatrixXd exact_factors(const Scene& scene, const Patches& patches, unsigned threads = 0);

/// Radiosity of one band from B = E + ρ F B, by LU decomposition.
Eigen::VectorXd exact_radiosity(const Eigen::MatrixXd& factors, const Patches& patches,
                                std::uint32_t band = 0);

/// The emission of a band as a vector; the reflectance likewise.
Eigen::VectorXd emission_of(const Patches& patches, std::uint32_t band = 0);
Eigen::VectorXd reflectance_of(const Patches& patches, std::uint32_t band = 0);

}  // namespace parallux
