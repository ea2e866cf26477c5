#include "reference/exact_factors.h"

#include <Eigen/LU>

#include "factors/form_factors.h"
#include "parallel.h"
#include "solve/emitters.h"

namespace parallux {

namespace {

Eigen::VectorXd band_of(const Patches& patches, const std::vector<float>& values,
                        std::uint32_t band) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(patches.count()));
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        result[static_cast<Eigen::Index>(patch)] = values[patch * patches.bands + band];
    return result;
}

}  // namespace

Eigen::MatrixXd exact_factors(const Scene& scene, const Patches& patches, unsigned threads) {
    refuse_curves(scene, "exact form factors are of planar ones");
    const auto n = static_cast<Eigen::Index>(patches.count());
    Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(n, n);
    const std::vector<Emitter> cells = all_cells(scene, patches);
    std::vector<Polygon> polygons;
    for (const Emitter& cell : cells)
        polygons.push_back(polygon_of(scene, cell));
    parallel_for(threads, cells.size(), 4, [&](std::size_t begin, std::size_t end, unsigned) {
        // Patches of several cells would meet here from several threads; each cell is a patch of
        // its own in the rooms this is for, and row i is written by its cell alone.
        for (std::size_t a = begin; a < end; ++a)
            for (std::size_t b = 0; b < cells.size(); ++b)
                factors(cells[a].patch, cells[b].patch) =
                    exchange_area(polygons[a], polygons[b]) / patches.area[cells[a].patch];
    });
    return factors;
}

Eigen::VectorXd emission_of(const Patches& patches, std::uint32_t band) {
    return band_of(patches, patches.emission, band);
}

Eigen::VectorXd reflectance_of(const Patches& patches, std::uint32_t band) {
    return band_of(patches, patches.reflectance, band);
}

Eigen::MatrixXd scattering_of(const Patches& patches, std::uint32_t band) {
    Eigen::MatrixXd matrix = reflectance_of(patches, band).asDiagonal();
    for (std::size_t patch = 0; patches.translucent() && patch < patches.count(); ++patch)
        if (const std::size_t q = patches.across(patch * patches.bands + band);
            q != Patches::no_side)
            matrix(static_cast<Eigen::Index>(patch), patches.other[patch]) =
                patches.transmittance[q];
    return matrix;
}

Eigen::VectorXd exact_radiosity(const Eigen::MatrixXd& factors, const Patches& patches,
                                std::uint32_t band) {
    Eigen::MatrixXd system = -(scattering_of(patches, band) * factors);
    system.diagonal().array() += 1;
    return system.partialPivLu().solve(emission_of(patches, band));
}

}  // namespace parallux
