#include "output/bake_values.h"

#include <cmath>

#include "parallux/error.h"

namespace parallux {

BakeValues::BakeValues(const Scene& scene, const Patches& patches, const Solution& solution,
                       Quantity quantity, bool flat, unsigned threads)
    : scene_(scene),
      patches_(patches),
      solution_(solution),
      quantity_(quantity),
      rays_(scene, threads) {
    if (!flat)
        field_.emplace(scene, patches, solution, rays_, threads);
}

void BakeValues::in_cell(std::uint32_t surface, bool back, std::uint32_t cell, double u, double v,
                         float* values) const {
    const std::uint32_t n = bands();
    const SurfaceGrid& grid = patches_.grids[surface];
    const std::size_t patch = std::size_t(back ? grid.back : grid.front) + cell;
    if (field_)
        field_->in_cell(surface, back, cell, u, v, values);
    else
        for (std::uint32_t b = 0; b < n; ++b)
            values[b] = solution_.irradiance[patch * n + b];
    if (quantity_ == Quantity::irradiance)
        return;
    // B = E + ρ H, and L = B / π.
    const Spectrum rho = surface_reflectance(scene_, surface, u, v);
    const Spectrum emission = surface_emission(scene_, surface, u, v);
    for (std::uint32_t b = 0; b < n; ++b) {
        values[b] = field_ ? emission[b] + rho[b] * values[b] : solution_.radiosity[patch * n + b];
        if (quantity_ == Quantity::radiance)
            values[b] = static_cast<float>(values[b] / pi);
        if (!std::isfinite(values[b]))
            throw Error(Fault::internal, "surface " + std::to_string(surface) +
                                             " has a value that is no finite number");
    }
}

void BakeValues::at(std::uint32_t surface, bool back, double u, double v, float* values) const {
    const SurfaceGrid& grid = patches_.grids[surface];
    in_cell(surface, back,
            cell_at(scene_.surfaces[surface].shape(), grid.nu, grid.nv, static_cast<float>(u),
                    static_cast<float>(v)),
            u, v, values);
}

glm::vec3 colour_of(const float* values, std::uint32_t bands) {
    if (bands == 3)
        return {values[0], values[1], values[2]};
    double sum = 0;
    for (std::uint32_t b = 0; b < bands; ++b)
        sum += values[b];
    return glm::vec3(static_cast<float>(bands ? sum / bands : 0));
}

const char* quantity_name(Quantity quantity) {
    switch (quantity) {
        case Quantity::irradiance:
            return "irradiance";
        case Quantity::radiosity:
            return "radiosity";
        case Quantity::radiance:
            break;
    }
    return "radiance";
}

const char* quantity_unit(Quantity quantity) {
    return quantity == Quantity::radiance ? "W/(m2 sr)" : "W/m2";
}

}  // namespace parallux
