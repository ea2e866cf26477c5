#pragma once

#include <memory>

#include <Eigen/Core>
#include <glm/vec3.hpp>

#include "solve/pass.h"

namespace parallux {

/// Lines that are only counted: n_ij between patches, n_i that leave each, what escapes, and what
/// comes from the sky. Takes matrix_bytes().
class CountedLines {
public:
    /// Keeps references to both.
    CountedLines(const Scene& scene, const Patches& patches);
    ~CountedLines();

    /// Adds the pairs of each list; `directions`, one a line, where the sky is lit.
    void count(const IntersectionLists& lists, const std::vector<glm::dvec3>& directions);

    /// H of one band in W/m² from H = F (E + ρ H) with F_ij = n_ij / n_i and E in W/m², patch by
    /// patch; the sky of the scene included. By conjugate gradients to 1e-13, where light goes
    /// through surfaces by Bi-CGSTAB.
    std::vector<double> irradiance(const std::vector<double>& emission, std::uint32_t band) const;

    const LineCounts& counts() const { return counts_; }
    const std::vector<std::uint64_t>& exits() const { return exits_; }
    /// Share of a patch's exits that met nothing or a back.
    double escaped(std::size_t patch) const;
    /// Irradiance that comes straight from the sky, W/m².
    double sky(std::size_t patch, std::uint32_t band) const;

private:
    struct Matrix;

    std::vector<double> irradiance_through(const std::vector<double>& emission,
                                           const Eigen::VectorXd& sky, const Eigen::VectorXd& exits,
                                           std::uint32_t band) const;

    void leave(std::uint32_t patch, const glm::dvec3* direction, double sign);
    void pair(std::uint32_t i, std::uint32_t j);

    const Scene& scene_;
    const Patches& patches_;
    LineCounts counts_;
    std::unique_ptr<Matrix> between_;
    std::vector<std::uint64_t> exits_, escaped_;
    std::vector<double> sky_;  // Σ π L over the exits that met the sky; patch · bands + band
};

/// M. Sbert, An integral geometry based method for fast form-factor computation (Eurographics
/// 1993): global lines are only counted, n_ij between patches i and j and n_i that leave i, F_ij =
/// n_ij / n_i, and H = F (E + ρ H) is solved, E being the unshot power of the first shots. Each
/// band is a symmetric positive definite system, by conjugate gradients to 1e-13. Takes
/// matrix_bytes(). A patch that no line left stays dark, with a warning. Counted form factors do
/// not keep A_i F_ij = A_j F_ji, so that the power received differs from that sent by the noise of
/// the counts: the balance has the difference as unshot.
PassResult matrix_pass(const Run& run, DirectLight& direct, TransferState& state);

/// Bytes of the counts between so many patches.
std::uint64_t matrix_bytes(std::uint64_t patches);

}  // namespace parallux
