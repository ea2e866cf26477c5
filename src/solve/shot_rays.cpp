#include "solve/shot_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "random.h"
#include "solve/plan_lines.h"
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

std::vector<std::uint32_t> smaller_than(const Patches& patches, double area) {
    std::vector<std::uint32_t> small;
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        if (patches.area[patch] < area)
            small.push_back(static_cast<std::uint32_t>(patch));
    return small;
}

}  // namespace

Relays::Relays(const Scene& scene, const Patches& patches, unsigned threads)
    : patches_(patches),
      small_(mean_area(patches) / 16),
      relays_(smaller_than(patches, small_)),
      cells_(scene, patches, relays_),
      sent_(threads, std::vector<std::int64_t>(relays_.size() * patches.bands, 0)) {
}

std::uint32_t Relays::find(std::uint32_t patch) const {
    if (patches_.area[patch] >= small_)
        return none;
    return static_cast<std::uint32_t>(cells_.find(patch));
}

std::int64_t* Relays::sent(unsigned worker, std::uint32_t place) {
    return &sent_[worker][place * std::size_t(patches_.bands)];
}

void Relays::add_to(std::vector<std::int64_t>& shot) const {
    const std::uint32_t bands = patches_.bands;
    for (const std::vector<std::int64_t>& worker : sent_)
        for (std::size_t place = 0; place < relays_.size(); ++place)
            for (std::uint32_t band = 0; band < bands; ++band)
                shot[relays_[place] * std::size_t(bands) + band] += worker[place * bands + band];
}

double shoot_rays(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key,
                  Relays* relays, const std::function<bool(double)>& go_on) {
    using Carried = std::array<std::int64_t, max_bands>;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (relays && relays->empty())
        relays = nullptr;
    const Sobol sobol(key);
    const RayQuanta quanta = ray_quanta(emitters, rays);
    const std::uint32_t bands = emitters.bands;
    // The normal of the surface that was last shot from: rays choose among patches, which most
    // often lie on few surfaces.
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
    // Takes what arrives, and sends on what a relay reflects of it; returns the relay's place.
    auto receive = [&](std::uint32_t patch, unsigned worker, Carried& carried) {
        WorkerTotals& totals = run.banks.totals(worker);
        const std::uint32_t place = patch == none || !relays ? none : relays->find(patch);
        bool goes_on = false;
        for (std::uint32_t band = 0; band < bands; ++band) {
            if (patch == none) {
                totals.escaped[band] += carried[band];
                continue;
            }
            const std::size_t k = patch * std::size_t(bands) + band;
            run.banks.receive(worker, k, carried[band]);
            if (place == none)
                continue;
            // Whole quanta, rounded down, so that no patch sends more than it reflects.
            carried[band] =
                static_cast<std::int64_t>(static_cast<double>(run.patches.reflectance[k]) *
                                          static_cast<double>(carried[band]));
            goes_on = goes_on || carried[band] > 0;
        }
        return goes_on ? place : none;
    };
    auto relay = [&](std::uint32_t place, std::uint64_t ray, unsigned worker, Carried& carried) {
        constexpr int longest = 64;
        Random random(key, stream::relays + ray);
        for (int bounce = 0; place != none && bounce < longest; ++bounce) {
            for (std::uint32_t band = 0; band < bands; ++band)
                relays->sent(worker, place)[band] += carried[band];
            const Emitter& from = relays->cells().choose(place, random.uniform());
            const double a = random.uniform(), b = random.uniform(), c = random.uniform(),
                         d = random.uniform();
            const SurfaceHit hit = run.rays->closest(
                point_on(run.scene, from, a, b),
                cosine_direction(emitter_normal(run.scene, from), c, d), infinity, from.surface);
            place = receive(patch_of(run.scene, run.patches, hit), worker, carried);
        }
    };
    auto shoot = [&](std::uint64_t ray, unsigned worker, Last& last) {
        std::array<double, Sobol::dimensions> p = sobol.point(static_cast<std::uint32_t>(ray));
        std::size_t piece = emitters.choose(p[0]);
        const Emitter& emitter = emitters.pieces[piece];
        SurfaceHit hit = run.rays->closest(point_on(run.scene, emitter, p[1], p[2]),
                                           cosine_direction(normal_of(emitter, last), p[3], p[4]),
                                           infinity, emitter.surface);
        // Counted where it was emitted (in `sky`, the totals of what comes in), and where it went.
        WorkerTotals& totals = run.banks.totals(worker);
        Carried carried{};
        for (std::uint32_t band = 0; band < bands; ++band) {
            carried[band] = quanta.each[piece * bands + band] +
                            (static_cast<std::int64_t>(ray) < quanta.rest[band] ? 1 : 0);
            totals.sky[band] += carried[band];
        }
        const std::uint32_t place = receive(patch_of(run.scene, run.patches, hit), worker, carried);
        if (place != none)
            relay(place, ray, worker, carried);
    };

    // In slabs, so that the caller is heard now and then.
    constexpr std::uint64_t slab = 1 << 18;
    std::uint64_t done = 0;
    while (done < rays) {
        std::uint64_t count = std::min(slab, rays - done);
        parallel_for(run.plan.threads, count, 2048,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         DenormalsOff guard;
                         Last last;
                         for (std::size_t k = begin; k < end; ++k)
                             shoot(done + k, worker, last);
                     });
        done += count;
        if (!go_on(static_cast<double>(done) / static_cast<double>(rays)))
            break;
    }
    return static_cast<double>(done) / static_cast<double>(rays);
}

}  // namespace parallux
