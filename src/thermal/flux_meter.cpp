#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "parallux/error.h"
#include "parallux/scatter.h"
#include "parallux/thermal.h"

namespace parallux {

// B. P. Welford's way to mean and spread; `groups`: this one included.
void FluxMeter::Spread::add(std::size_t k, double value, std::uint32_t groups) {
    const double step = value - mean[k];
    mean[k] += step / groups;
    squares[k] += step * (value - mean[k]);
}

// Of the mean.
double FluxMeter::Spread::error(std::size_t k, std::uint32_t groups) const {
    return groups < 2 ? 0 : std::sqrt(squares[k] / (double(groups) * (groups - 1)));
}

FluxMeter::FluxMeter(const Scene& scene, const Patches& patches, FluxUnit unit)
    : scene_(scene), patches_(patches), unit_(unit) {
    if (patches.bands != 1)
        throw Error(Fault::internal, "fluxes need one band");
    const std::vector<PatchPlace> places = patch_places(scene, patches);
    std::vector<std::uint32_t> first_of(scene.materials.size());
    for (std::uint32_t m = 0; m < first_of.size(); ++m) {
        // A material that has several temperatures is one unit all the same.
        first_of[m] = 0;
        while (scene.materials[first_of[m]].name != scene.materials[m].name)
            ++first_of[m];
    }
    std::vector<std::uint32_t> number;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        const Surface& surface = scene.surfaces[places[patch].surface];
        const std::uint32_t key = unit == FluxUnit::patch     ? static_cast<std::uint32_t>(patch)
                                  : unit == FluxUnit::surface ? places[patch].surface
                                  : unit == FluxUnit::object  ? surface.object
                                                              : first_of[surface.material];
        if (key >= number.size())
            number.resize(key + 1, none);
        if (number[key] == none) {
            number[key] = static_cast<std::uint32_t>(names_.size());
            const bool numbered = unit == FluxUnit::patch || unit == FluxUnit::surface;
            names_.push_back(numbered                   ? std::to_string(key)
                             : unit == FluxUnit::object ? scene.objects[key]
                                                        : scene.materials[key].name);
        }
        unit_of_.push_back(number[key]);
    }
    sums_.assign(patches.count(), 0);
    patch_.mean = patch_.squares = sums_;
    units_.mean.assign(names_.size() + 1, 0);
    units_.squares = units_.mean;
}

Preview FluxMeter::preview() {
    // After every group, however short.
    return {1e-12, std::bind_front(&FluxMeter::see, this)};
}

// Takes the newest group out of the mean of all so far. Groups count alike here; in the solution
// they do by their lines, which are as many to within the chance of a patch.
void FluxMeter::see(const Solution& so_far) {
    if (so_far.groups != groups_ + 1)
        return;
    ++groups_;
    std::vector<double> absorbed(names_.size() + 1, 0);
    for (std::size_t patch = 0; patch < patches_.count(); ++patch) {
        const double sum = double(groups_) * so_far.irradiance[patch];
        const double own = sum - std::exchange(sums_[patch], sum);
        patch_.add(patch, own, groups_);
        const double watts = patches_.area[patch] * absorptance(patch) * own;
        absorbed[unit_of_[patch]] += watts;
        absorbed.back() += watts;
    }
    for (std::size_t unit = 0; unit < absorbed.size(); ++unit)
        units_.add(unit, absorbed[unit], groups_);
}

Fluxes FluxMeter::fluxes(const Solution& solution) {
    see(solution);
    const bool known = groups_ > 1 && groups_ == solution.groups;
    Fluxes result;
    result.unit = unit_;
    result.closed = std::all_of(solution.energy.escaped.begin(), solution.energy.escaped.end(),
                                [](std::int64_t quanta) { return quanta == 0; });
    std::vector<double> incoming(solution.irradiance.begin(), solution.irradiance.end());

    // Where nothing can leave, what is left over is error: share it by the squares of the errors.
    double most = 0;  // Σ (A ε σ_H)²
    for (std::size_t patch = 0; patch < incoming.size(); ++patch) {
        const double watts = patches_.area[patch] * absorptance(patch);
        result.leaving += patches_.area[patch] * patches_.emission[patch] - watts * incoming[patch];
        most += std::pow(watts * patch_.error(patch, groups_), 2);
    }
    if (known)
        result.leaving_stderr = units_.error(names_.size(), groups_);
    if (result.closed && known && most > 0) {
        result.imbalance = std::exchange(result.leaving, 0.0);
        for (std::size_t patch = 0; patch < incoming.size(); ++patch)
            incoming[patch] += result.imbalance * patches_.area[patch] * absorptance(patch) *
                               std::pow(patch_.error(patch, groups_), 2) / most;
    }

    // Sum them up, then make means of the sums.
    result.rows.resize(names_.size());
    for (std::size_t patch = 0; patch < incoming.size(); ++patch) {
        Flux& row = result.rows[unit_of_[patch]];
        const double area = patches_.area[patch], absorbs = absorptance(patch);
        row.area += area;
        row.absorptance += area * absorbs;
        row.emission += area * patches_.emission[patch];
        row.incoming += area * incoming[patch];
        row.outgoing +=
            area * (patches_.emission[patch] +
                    scattered(patches_, patch, [&](std::size_t at) { return incoming[at]; }));
        row.net += area * (patches_.emission[patch] - absorbs * incoming[patch]);
    }
    for (std::size_t unit = 0; unit < names_.size(); ++unit) {
        Flux& row = result.rows[unit];
        row.name = names_[unit];
        for (double* sum :
             {&row.absorptance, &row.emission, &row.incoming, &row.outgoing, &row.net})
            *sum /= row.area;
        if (known)
            row.net_stderr = units_.error(unit, groups_) / row.area;
    }
    return result;
}

}  // namespace parallux
