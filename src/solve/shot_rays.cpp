#include "solve/shot_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "random.h"
#include "solve/quanta_sink.h"
#include "solve/sobol.h"

namespace parallux {

std::uint32_t patch_of(const Scene& scene, const Patches& patches, const SurfaceHit& hit) {
    if (hit.surface == none)
        return none;
    const SurfaceGrid& grid = patches.grids[hit.surface];
    std::uint32_t first = hit.back ? grid.back : grid.front;
    if (first == none)
        return none;
    return first + cell_at(scene.surfaces[hit.surface].shape(), grid.nu, grid.nv, hit.u, hit.v);
}

namespace {

// What every ray of a piece carries: whole quanta, bands together. A patch alone also has a rest,
// one quantum more for the first so many rays.
struct RayQuanta {
    std::vector<std::int64_t> each;
    std::vector<std::int64_t> rest;
};

RayQuanta ray_quanta(const Emitters& emitters, std::uint64_t rays) {
    RayQuanta quanta;
    std::uint32_t bands = emitters.bands;
    quanta.rest.assign(bands, 0);
    std::uint32_t patch = emitters.pieces[0].patch;
    bool single = std::all_of(emitters.pieces.begin(), emitters.pieces.end(),
                              [&](const Emitter& piece) { return piece.patch == patch; });
    if (single) {
        std::vector<double> whole(bands, 0);
        for (std::size_t k = 0; k < emitters.power.size(); ++k)
            whole[k % bands] += emitters.power[k];
        std::vector<std::int64_t> each(bands);
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::int64_t power = std::llrint(whole[band]), count = static_cast<std::int64_t>(rays);
            each[band] = power / count;
            quanta.rest[band] = power % count;
        }
        for (std::size_t piece = 0; piece < emitters.pieces.size(); ++piece)
            quanta.each.insert(quanta.each.end(), each.begin(), each.end());
        return quanta;
    }
    quanta.each.reserve(emitters.power.size());  // an array that grows takes twice the memory
    for (std::size_t piece = 0; piece < emitters.pieces.size(); ++piece) {
        double sum = 0;
        for (std::uint32_t band = 0; band < bands; ++band)
            sum += emitters.power[piece * bands + band];
        for (std::uint32_t band = 0; band < bands; ++band)
            quanta.each.push_back(std::llrint(emitters.power[piece * bands + band] / sum *
                                              emitters.total / static_cast<double>(rays)));
    }
    return quanta;
}

}  // namespace

double shoot_rays(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key,
                  std::uint64_t& done, const std::function<bool(double)>& go_on) {
    const Sobol sobol(key);
    const RayQuanta quanta = ray_quanta(emitters, rays);
    const std::uint32_t bands = emitters.bands;
    // The normal of the surface that was last shot from: neighbours among the rays most often have
    // it in common.
    struct Last {
        const Emitter* emitter = nullptr;
        glm::dvec3 normal{0};
    };
    auto normal_of = [&](const Emitter& emitter, Last& last) -> const glm::dvec3& {
        if (!last.emitter || last.emitter->surface != emitter.surface ||
            last.emitter->back != emitter.back)
            last = {&emitter, emitter_normal(run.scene, emitter)};
        return last.normal;
    };
    auto carried_by = [&](std::uint64_t ray, std::size_t piece) {
        Quanta carried{};
        for (std::uint32_t band = 0; band < bands; ++band)
            carried[band] = quanta.each[piece * bands + band] +
                            (static_cast<std::int64_t>(ray) < quanta.rest[band] ? 1 : 0);
        return carried;
    };
    // Beside walks, counted where it was emitted in the totals' `sky`.
    auto walk = [&](std::uint64_t ray, const Walk& start, const Quanta& carried, unsigned worker,
                    const QuantaSink& sink) {
        for (std::uint32_t band = 0; band < bands; ++band)
            run.banks.totals(worker).sky[band] += carried[band];
        Random random(key, stream::shot_walks + ray);
        carry(start, carried, bands, random, sink);
    };
    // `at`: the share of the power that lies before the place the ray leaves from.
    auto shoot = [&](std::uint64_t ray, double at, unsigned worker, Last& last,
                     const QuantaSink& sink) {
        std::array<double, Sobol::dimensions> p = sobol.point(static_cast<std::uint32_t>(ray));
        std::size_t piece = emitters.choose(at);
        const Emitter& emitter = emitters.pieces[piece];
        const EmitterPlace place =
            run.scene.surfaces[emitter.surface].is_curved()
                ? place_on(run.scene, emitter, p[0], p[1])
                : EmitterPlace{point_on(run.scene, emitter, p[0], p[1]), normal_of(emitter, last)};
        const glm::dvec3 direction = cosine_direction(place.normal, p[2], p[3]);
        if (run.walks)
            return walk(ray, Walk(*run.walks, place.point, direction, emitter.surface),
                        carried_by(ray, piece), worker, sink);
        SurfaceHit hit = run.rays->closest(
            place.point, direction, std::numeric_limits<double>::infinity(), emitter.surface);
        std::uint32_t patch = patch_of(run.scene, run.patches, hit);
        // Counted where it was emitted (in `sky`, the totals of what comes in), and where it went.
        WorkerTotals& totals = run.banks.totals(worker);
        const Quanta quanta_here = carried_by(ray, piece);
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::int64_t carried = quanta_here[band];
            totals.sky[band] += carried;
            if (patch == none)
                totals.escaped[band] += carried;
            else
                run.banks.receive(worker, patch * std::size_t(bands) + band, carried);
        }
    };

    // In slabs, so that the caller is heard now and then. The rays of a slab step through the power
    // evenly, so that neighbours leave the same emitter, with a run of the sequence each.
    constexpr std::uint64_t slab = 1 << 18;
    while (done < rays) {
        const std::uint64_t count = std::min(slab, rays - done);
        const double step = 1 / static_cast<double>(count);
        const double offset = Random(key, stream::ray_steps + done / slab).uniform();
        parallel_for(run.plan.threads, count, 2048,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         DenormalsOff guard;
                         Last last;
                         const QuantaSink sink = bank_sink(run, worker);
                         for (std::size_t k = begin; k < end; ++k)
                             shoot(done + k, (static_cast<double>(k) + offset) * step, worker, last,
                                   sink);
                     });
        done += count;
        if (!go_on(static_cast<double>(done) / static_cast<double>(rays)))
            break;
    }
    return static_cast<double>(done) / static_cast<double>(rays);
}

}  // namespace parallux
