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

// A surface's normal, kept from ray to ray: neighbours among them most often leave the same one.
class LastNormal {
public:
    const glm::dvec3& of(const Scene& scene, const Emitter& emitter) {
        if (!emitter_ || emitter_->surface != emitter.surface || emitter_->back != emitter.back) {
            emitter_ = &emitter;
            normal_ = emitter_normal(scene, emitter);
        }
        return normal_;
    }

private:
    const Emitter* emitter_ = nullptr;
    glm::dvec3 normal_{0};
};

class RayShooter {
public:
    RayShooter(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key)
        : run_(run),
          emitters_(emitters),
          bands_(emitters.bands),
          key_(key),
          sobol_(key),
          quanta_(ray_quanta(emitters, rays)) {}

    // `at`: the share of the power that lies before the place the ray leaves from. What it carries
    // is counted where it was emitted (in `sky`, the totals of what comes in), and where it went.
    void shoot(std::uint64_t ray, double at, unsigned worker, LastNormal& normal,
               const QuantaSink& sink) const {
        const std::array<double, Sobol::dimensions> p =
            sobol_.point(static_cast<std::uint32_t>(ray));
        const std::size_t piece = emitters_.choose(at);
        const Emitter& emitter = emitters_.pieces[piece];
        const glm::dvec3 from = point_on(run_.scene, emitter, p[0], p[1]);
        const glm::dvec3 direction = cosine_direction(normal.of(run_.scene, emitter), p[2], p[3]);
        const Quanta carried = carried_by(ray, piece);
        WorkerTotals& totals = run_.banks.totals(worker);
        for (std::uint32_t band = 0; band < bands_; ++band)
            totals.sky[band] += carried[band];
        if (run_.walks) {
            Random random(key_, stream::shot_walks + ray);
            return carry(Walk(*run_.walks, from, direction, emitter.surface), carried, bands_,
                         random, sink);
        }
        const SurfaceHit hit = run_.rays->closest(
            from, direction, std::numeric_limits<double>::infinity(), emitter.surface);
        const std::uint32_t patch = patch_of(run_.scene, run_.patches, hit);
        for (std::uint32_t band = 0; band < bands_; ++band)
            if (patch == none)
                totals.escaped[band] += carried[band];
            else
                run_.banks.receive(worker, patch * std::size_t(bands_) + band, carried[band]);
    }

private:
    Quanta carried_by(std::uint64_t ray, std::size_t piece) const {
        Quanta carried{};
        for (std::uint32_t band = 0; band < bands_; ++band)
            carried[band] = quanta_.each[piece * bands_ + band] +
                            (static_cast<std::int64_t>(ray) < quanta_.rest[band] ? 1 : 0);
        return carried;
    }

    const Run& run_;
    const Emitters& emitters_;
    const std::uint32_t bands_;
    const std::uint64_t key_;
    const Sobol sobol_;
    const RayQuanta quanta_;
};

}  // namespace

double shoot_rays(const Run& run, const Emitters& emitters, std::uint64_t rays, std::uint64_t key,
                  std::uint64_t& done, const std::function<bool(double)>& go_on) {
    const RayShooter shooter(run, emitters, rays, key);
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
                         LastNormal normal;
                         const QuantaSink sink = bank_sink(run, worker);
                         for (std::size_t k = begin; k < end; ++k)
                             shooter.shoot(done + k, (static_cast<double>(k) + offset) * step,
                                           worker, normal, sink);
                     });
        done += count;
        if (!go_on(static_cast<double>(done) / static_cast<double>(rays)))
            break;
    }
    return static_cast<double>(done) / static_cast<double>(rays);
}

}  // namespace parallux
