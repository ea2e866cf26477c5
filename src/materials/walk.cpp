#include "materials/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace parallux {

Walks::Walks(const Scene& the_scene, const Patches& the_patches, const RayScene& the_rays)
    : scene(the_scene), patches(the_patches), rays(the_rays), rough_(the_scene.materials.size()) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Specular& specular = scene.materials[m].specular;
        if (specular.kind == Specular::Kind::mirror && specular.share > 0 && specular.roughness > 0)
            rough_[m] = std::make_shared<Microfacets>(
                std::max(1e-4, double(specular.roughness) * specular.roughness));
    }
}

bool Walk::advance(Weights& passed) {
    hit_ = walks_.rays.closest(origin_, direction_, std::numeric_limits<double>::infinity(), skip_);
    if (hit_.surface == none)
        return false;
    const Surface& surface = walks_.scene.surfaces[hit_.surface];
    const Material& material = walks_.scene.materials[surface.material];
    // The back of a body of glass is met from within.
    if (hit_.back && material.specular.kind == Specular::Kind::glass && !material.specular.thin)
        medium_ = surface.material;
    if (medium_ != none) {
        const Spectrum& absorption = walks_.scene.materials[medium_].specular.absorption;
        for (std::uint32_t band = 0; band < walks_.scene.bands; ++band)
            passed[band] *= std::exp(-double(absorption[band]) * hit_.t);
    }
    const SurfaceGrid& grid = walks_.patches.grids[hit_.surface];
    const std::uint32_t first = hit_.back ? grid.back : grid.front;
    patch_ =
        first == none ? none : first + cell_at(surface.shape(), grid.nu, grid.nv, hit_.u, hit_.v);
    share_ = patch_ == none ? 0 : walks_.patches.specular_share(patch_);
    return true;
}

double Walk::bounce(Random& random, Weights& passed) {
    if (++bounces_ > most_bounces) {
        passed.fill(0);
        return 1;
    }
    const Scene& scene = walks_.scene;
    const Surface& surface = scene.surfaces[hit_.surface];
    const Specular& specular = scene.materials[surface.material].specular;
    const glm::dvec3 normal = surface_normal(scene, surface) * (hit_.back ? -1.0 : 1.0);
    const bool body = specular.kind == Specular::Kind::glass && !specular.thin;
    const Bounce way = parallux::bounce(specular, surface_tint(scene, hit_.surface, hit_.u, hit_.v),
                                        walks_.rough(surface.material), direction_, normal,
                                        body && hit_.back, random, passed);
    if (body)
        medium_ = way.through != hit_.back ? surface.material : none;
    origin_ = surface_point(scene, surface, hit_.u, hit_.v);
    direction_ = way.direction;
    skip_ = hit_.surface;
    return way.radiance;
}

namespace {

Weights all_of_it() {
    Weights weights;
    weights.fill(1);
    return weights;
}

std::int64_t sum_of(const Quanta& quanta, std::uint32_t bands) {
    std::int64_t sum = 0;
    for (std::uint32_t band = 0; band < bands; ++band)
        sum += quanta[band];
    return sum;
}

// Parts of quanta, whole ones and right in the mean; the rest stays.
Quanta part_of(Quanta& quanta, const Weights& parts, std::uint32_t bands, Random& random) {
    Quanta taken{};
    const double dither = random.uniform();
    for (std::uint32_t band = 0; band < bands; ++band) {
        const double wanted = static_cast<double>(quanta[band]) * parts[band];
        const auto whole = static_cast<std::int64_t>(std::floor(wanted + dither));
        taken[band] = quanta[band] >= 0 ? std::clamp<std::int64_t>(whole, 0, quanta[band])
                                        : std::clamp<std::int64_t>(whole, quanta[band], 0);
        quanta[band] -= taken[band];
    }
    return taken;
}

}  // namespace

void carry(Walk walk, Quanta quanta, std::uint32_t bands, Random& random, const QuantaSink& sink) {
    constexpr std::int64_t little = 16;  // of so many parts
    const std::int64_t begun = sum_of(quanta, bands);
    auto is_gone = [&] {
        return std::all_of(quanta.begin(), quanta.begin() + bands,
                           [](std::int64_t one) { return one == 0; });
    };
    Weights passed = all_of_it();
    while (!is_gone()) {
        const bool met = walk.advance(passed);
        // What the way took, and the bounce before it, is absorbed.
        double most = 0;
        for (std::uint32_t band = 0; band < bands; ++band)
            if (quanta[band] != 0)
                most = std::max(most, passed[band]);
        if (std::abs(sum_of(quanta, bands)) < std::abs(begun) / little && most < 1) {
            if (random.uniform() >= most)
                return sink.lose(quanta);
            for (double& part : passed)
                part = std::min(1.0, part / most);
        }
        if (most < 1 || std::any_of(passed.begin(), passed.begin() + bands,
                                    [](double part) { return part < 1; })) {
            const Quanta kept = part_of(quanta, passed, bands, random);
            sink.lose(quanta);
            quanta = kept;
        }
        if (!met || walk.patch() == none)
            return sink.escape(quanta);
        // The diffuse part takes its share, the walk goes on with the other.
        if (walk.share() == 0)
            return sink.land(walk.patch(), quanta);
        if (walk.share() < 1) {
            Weights goes_on;
            goes_on.fill(walk.share());
            const Quanta kept = part_of(quanta, goes_on, bands, random);
            sink.land(walk.patch(), quanta);
            quanta = kept;
        }
        passed = all_of_it();
        walk.bounce(random, passed);
    }
}

void follow_sight(Walk walk, Weights weights, std::uint32_t bands, Random& random,
                  const std::function<void(const Walk&, const Weights&)>& visit,
                  const std::function<void(const glm::dvec3&, const Weights&)>& sky) {
    const auto most_of = [&] {
        return *std::max_element(weights.begin(), weights.begin() + bands);
    };
    const double little = most_of() / 8;
    while (most_of() > 0) {
        if (!walk.advance(weights))
            return sky(walk.direction(), weights);
        if (walk.patch() == none)
            return;
        visit(walk, weights);
        if (walk.share() == 0)
            return;
        const double radiance = walk.bounce(random, weights);
        for (double& weight : weights)
            weight *= walk.share() * radiance;
        if (const double most = most_of(); most < little) {
            if (random.uniform() * little >= most)
                return;
            for (double& weight : weights)
                weight *= little / most;
        }
    }
}

}  // namespace parallux
