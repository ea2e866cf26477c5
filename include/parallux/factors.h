#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/scene.h"
#include "parallux/solve.h"

// View factors: how much of what leaves one part of the scene diffusely reaches each other part,
// the sky and the ground, from the same line bundles as the solver, which are only counted.

namespace parallux {

/// What factors are between. Surfaces count a side each, as patches do.
enum class FactorNodes { patches, surfaces, objects, materials };

/// How the sky is cut: one part; the 145 of P. R. Tregenza (Subdivision of the sky hemisphere for
/// luminance measurements, 1987); or those of C. F. Reinhart, each side halved: 577.
enum class SkyParts { whole, tregenza, reinhart };

/// Where sky factors come from: the counted lines, or points on each patch, at which they are in
/// closed form past the scene's polygons; with `automatic`, points where they cost no more than
/// two or three times what counting does (scenes of few polygons), the scene does not repeat, and
/// the sky is one.
enum class SkyFrom { automatic, lines, points };

struct FactorSettings {
    FactorNodes between = FactorNodes::patches;
    SkyParts sky_parts = SkyParts::whole;
    SkyFrom sky_from = SkyFrom::automatic;
    double sky_tolerance = 1e-4;   ///< points: when more of them change a patch by less, enough
    std::uint64_t bundles = 4096;  ///< of all groups together
    double line_spacing = 0;       ///< δ, metres; 0: from lines_per_patch
    double lines_per_patch = 0;    ///< c: δ² = mean patch area / c; 0: 4 to 64, as the third
                                   ///< root of a group's bundles, 8 at 128; more in scenes of few
                                   ///< patches, so that a bundle has 16 384 lines
    std::uint32_t groups = 0;      ///< whose spread tells the errors; 0: 8 from 64 bundles on
    DirectionSet directions = DirectionSet::lattice;
    double threshold = 0;  ///< factors below it, both ways, are left out
    std::uint64_t seed = 1;
    unsigned threads = 0;          ///< 0: all
    std::uint64_t max_memory = 0;  ///< bytes; 0: what the machine has
};

/// A row of the factors.
struct FactorNode {
    std::string name, material;  ///< material "": several
    double area = 0;             ///< m²
    glm::dvec3 centre{0};
    glm::dvec3 normal{0};  ///< mean by area, unit; 0 where there is none
};

/// Sparse factors F_ij = exchange_ij / area_i. Both triangles are stored, with the same bits:
/// reciprocity A_i F_ij = A_j F_ji is exact. Σ_j exchange_ij + A_i Σ_k outside_ik = A_i to 1e-12.
struct Factors {
    std::vector<FactorNode> nodes;
    std::vector<std::uint64_t> start;  ///< nodes + 1 offsets, rows by ascending column
    std::vector<std::uint32_t> column;
    std::vector<double> exchange;  ///< A_i F_ij, m²
    std::uint32_t sky_parts = 1;
    /// A node's factors to the sky_parts parts of the sky, then to the ground (what leaves the
    /// scene below the horizon), then to inert backs of one-sided surfaces.
    std::vector<double> outside;
    std::vector<double> outside_error;  ///< standard errors, from groups; empty from one alone
    std::vector<double> sky_error;      ///< of a node's whole sky; from points: a bound in practice
    bool sky_from_points = false;
    std::vector<std::uint64_t> exits;  ///< lines that left each node, weighed, rounded up

    double rms_factor = 0;  ///< √(Σ_i A_i Σ_j σ_ij² / Σ_i A_i), σ_ij standard error of F_ij
    double rms_sky = 0;     ///< √(Σ_i A_i σ_i² / Σ_i A_i), of the whole sky
    LineCounts counts;
    std::uint64_t leaks = 0;    ///< closed scenes: lines that met an odd number of surfaces
    std::uint64_t unseen = 0;   ///< nodes that no line left: F_ii = 1
    std::uint64_t dropped = 0;  ///< entries below the threshold, both triangles
    double rest = 0;            ///< share of all area that lines could not place: on the diagonal
    std::uint32_t groups = 1;
    std::uint64_t bundles = 0;  ///< done
    double line_spacing = 0;
    unsigned threads = 0;
    std::uint64_t predicted_memory = 0;  ///< bytes, as said after the first bundles
    double count_seconds = 0, sky_seconds = 0, scale_seconds = 0;
    bool partial = false;
    std::vector<std::string> warnings;

    std::uint32_t outsides() const { return sky_parts + 2; }
};

/// How far the stored numbers are from the identities.
struct FactorCheck {
    double row_deviation = 0;  ///< largest |Σ_j F_ij + Σ_k outside_ik - 1|
    double reciprocity = 0;    ///< largest |exchange_ij - exchange_ji|, m²; 0 by construction
    double smallest = 0;       ///< smallest F or outside factor
};

/// Counts lines: n_ij between nodes i and j, symmetric because one line serves both, and n_i that
/// leave i. n_ij / n_i would close each row, but be reciprocal up to the noise of n_i / A_i only;
/// so exchange areas are d_i n_ij d_j with one factor d_i a node, near one, that makes every row
/// with its outside come to A_i (symmetric scaling of R. Sinkhorn, 1964, by Newton's method).
/// Under a threshold T, entries with F_ij < T and F_ji < T are left out, but for the largest of a
/// row, and the rest is scaled again: what they had goes to the others of their rows, in
/// proportion. What no scaling can place, where few lines left a node, stays on the diagonal and
/// is told in `rest`. In a scene that repeats, factors to all copies of a node are one. Storage
/// grows with the pairs that see each other. Equal bits on any number of threads. Throws
/// Fault::memory when it needs more than max_memory: before it begins, after the first bundles have
/// told how many pairs there are, or when there are more nevertheless.
Factors view_factors(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                     const ProgressCallback& progress = {});

FactorCheck check_factors(const Factors& factors);

/// What a matrix file holds.
enum class FactorValues { exchange, factors };

/// By the name's ending: .mtx, Matrix Market coordinates, `symmetric` (lower triangle) of exchange
/// areas, `general` of factors; .npz, both triangles as scipy.sparse.load_npz reads them. Numbers
/// are read back as the same bits. Exchange areas are exactly reciprocal; factors to rounding. The
/// file is whole or untouched; throws Fault::output, Fault::usage for another ending.
void write_factors(const std::filesystem::path& file, const Factors& factors, FactorValues values);

/// node,name,material,area,x,y,z,nx,ny,nz; all digits.
void write_factor_areas(const std::filesystem::path& file, const Factors& factors);

/// node,sky,stderr_sky,ground,backs, and with several parts sky_1,stderr_1,…; all digits.
void write_sky_factors(const std::filesystem::path& file, const Factors& factors);

/// What the program knows beside the factors, for their statistics.
struct FactorRun {
    double load_seconds = 0, patches_seconds = 0, output_seconds = 0, total_seconds = 0;
    std::uint64_t bytes = 0;  ///< of the files written
};

/// One JSON object; keys as the README lists them.
void write_factor_stats(const std::filesystem::path& file, const Scene& scene,
                        const Patches& patches, const FactorSettings& settings,
                        const Factors& factors, const FactorRun& run);

}  // namespace parallux
