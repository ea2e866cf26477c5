#include "output/bake_values.h"

#include <cmath>

#include "parallux/error.h"

namespace parallux {

namespace {

// Reflectance without the material's picture.
Spectrum plain_reflectance(const Scene& scene, std::uint32_t surface, double u, double v) {
    Spectrum rho = scene.materials[scene.surfaces[surface].material].reflectance;
    if (scene.attributes.empty())
        return rho;
    const auto& c = scene.attributes[surface].colour;
    for (int b = 0; b < 3; ++b)
        rho[static_cast<std::size_t>(b)] *=
            static_cast<float>(c[0][b] + u * (c[1][b] - c[0][b]) + v * (c[2][b] - c[0][b]));
    return rho;
}

}  // namespace

BakeValues::BakeValues(const Scene& scene, const Patches& patches, const Solution& solution,
                       const BakeSettings& settings)
    : scene_(scene),
      patches_(patches),
      solution_(solution),
      settings_(settings),
      rays_(scene, settings.threads) {
    if (!settings.flat)
        field_.emplace(scene, patches, solution, rays_, settings.threads);
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
    if (settings_.quantity == Quantity::irradiance)
        return;
    // B = E + ρ H and what comes through, L = B / π. A picture that is kept is left out of ρ; it
    // lies over all that a viewer shows, so that what lets light through keeps none.
    const bool kept = keeps_picture(scene_, settings_, scene_.surfaces[surface].material);
    const Spectrum rho = kept ? plain_reflectance(scene_, surface, u, v)
                              : surface_reflectance(scene_, surface, u, v, back);
    const Spectrum emission = surface_emission(scene_, surface, u, v);
    const Spectrum through =
        field_ ? field_->coming_through(surface, back, cell, u, v) : Spectrum{};
    for (std::uint32_t b = 0; b < n; ++b) {
        values[b] = field_ || kept ? emission[b] + rho[b] * values[b] + through[b]
                                   : solution_.radiosity[patch * n + b];
        if (settings_.quantity == Quantity::radiance)
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

bool keeps_picture(const Scene& scene, const BakeSettings& settings, std::uint32_t material) {
    const Material& m = scene.materials[material];
    return settings.textures && settings.quantity != Quantity::irradiance && scene.bands == 3 &&
           m.reflectance_texture != none && m.reflectance_uv == 0 && m.emission == Spectrum{} &&
           !m.is_translucent() && !m.own_back;
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
