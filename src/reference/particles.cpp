#include "reference/particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "parallel.h"
#include "random.h"
#include "reference/sky_points.h"
#include "solve/emitters.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

using Quanta = std::array<std::int64_t, max_bands>;

class Walker {
public:
    Walker(const Run& run, const Emitters& emitters)
        : run_(run), emitters_(emitters), cells_(run.scene, run.patches) {}

    // One particle, from its birth to where it is absorbed or leaves the scene.
    void walk(std::uint64_t number, unsigned worker) const {
        Random random(run_.settings.seed, stream::particles + number);
        std::size_t piece = emitters_.choose(random.uniform());
        const Emitter* from = &emitters_.pieces[piece];
        Quanta carried = birth(piece);
        WorkerTotals& totals = run_.banks.totals(worker);
        for (std::uint32_t band = 0; band < emitters_.bands; ++band)
            totals.sky[band] += carried[band];
        for (;;) {
            double p[4];
            for (double& x : p)
                x = random.uniform();
            SurfaceHit hit =
                run_.rays->closest(point_on(run_.scene, *from, p[0], p[1]),
                                   cosine_direction(emitter_normal(run_.scene, *from), p[2], p[3]),
                                   std::numeric_limits<double>::infinity(), from->surface);
            ++totals.counts.lines;
            std::uint32_t patch = patch_of(run_.scene, run_.patches, hit);
            if (patch == none) {
                for (std::uint32_t band = 0; band < emitters_.bands; ++band)
                    totals.escaped[band] += carried[band];
                return;
            }
            ++totals.counts.hits;
            for (std::uint32_t band = 0; band < emitters_.bands; ++band)
                run_.banks.receive(worker, patch * std::size_t(emitters_.bands) + band,
                                   carried[band]);
            patch = go_on(patch, random.uniform(), carried);
            if (patch == none)
                return;
            from = &cells_.choose(patch, random.uniform());
        }
    }

private:
    // Every particle carries the same power, summed over bands.
    Quanta birth(std::size_t piece) const {
        const double* power = &emitters_.power[piece * emitters_.bands];
        double sum = std::accumulate(power, power + emitters_.bands, 0.0);
        Quanta quanta{};
        for (std::uint32_t band = 0; band < emitters_.bands; ++band)
            quanta[band] = std::llrint(power[band] / sum * emitters_.total /
                                       static_cast<double>(run_.plan.lines));
        return quanta;
    }

    // Russian roulette with the highest reflectance q; band b goes on with ρ_b / q of its power.
    // Likewise with the highest transmittance, to the other side; both together at most always.
    std::uint32_t go_on(std::uint32_t patch, double chance, Quanta& carried) const {
        const Patches& patches = run_.patches;
        const std::size_t first = patch * std::size_t(emitters_.bands);
        const float* share = &patches.reflectance[first];
        double survival = *std::max_element(share, share + emitters_.bands);
        std::uint32_t next = patch;
        if (patches.translucent()) {
            const float* tau = &patches.transmittance[first];
            double through = *std::max_element(tau, tau + emitters_.bands);
            const double all = std::max(1.0, survival + through);
            survival /= all, through /= all;
            if (chance >= survival) {
                chance -= survival;
                survival = through;
                share = tau;
                next = patches.other[patch];
            }
        }
        if (chance >= survival)
            return none;
        for (std::uint32_t band = 0; band < emitters_.bands; ++band)
            carried[band] = std::llrint(static_cast<double>(share[band]) / survival *
                                        static_cast<double>(carried[band]));
        return next;
    }

    const Run& run_;
    const Emitters& emitters_;
    const PatchCells cells_;
};

}  // namespace

PassResult particle_pass(const Run& run, DirectLight& direct, TransferState& state) {
    add_sky_points(run, direct);
    settle(run, direct);
    PassResult result;
    Emission exitance = emission_of(run.patches, direct);
    exitance.quanta = 1 / run.plan.watts_per_quantum;
    const Emitters emitters = emitters_of(run.scene, run.patches, [&](std::size_t k) {
        return std::llrint(run.patches.area[k / state.bands] * exitance.of_exit(run.patches, k));
    });
    if (emitters.pieces.empty())
        return result;

    // In slabs, so that the caller is heard now and then.
    const Walker walker(run, emitters);
    constexpr std::uint64_t slab = 1 << 18;
    std::uint64_t done = 0;
    while (done < run.plan.lines) {
        std::uint64_t count = std::min(slab, run.plan.lines - done);
        parallel_for(run.plan.threads, count, 1024,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         DenormalsOff guard;
                         for (std::size_t k = begin; k < end; ++k)
                             walker.walk(done + k, worker);
                     });
        done += count;
        for (WorkerTotals& totals : run.banks.all_totals())
            result.counts += std::exchange(totals.counts, {});
        result.done = static_cast<double>(done) / static_cast<double>(run.plan.lines);
        if (!run.listener.go_on("particles", result.done, result.counts.lines))
            break;
    }
    result.whole = done == run.plan.lines;
    result.counts.nonempty = result.counts.hits;

    // Every walk has ended: what did not escape was absorbed, what was reflected sent on. Particles
    // stopped early stand for those not born.
    run.banks.take_totals(state.emitted, state.escaped, state.lost);
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        state.emitted[band] = std::llrint(static_cast<double>(state.emitted[band]) / result.done);
        state.escaped[band] = std::llrint(static_cast<double>(state.escaped[band]) / result.done);
        state.absorbed[band] = state.emitted[band] - state.escaped[band];
    }
    result.received = 1 / result.done;
    for (std::size_t k = 0; k < state.sent.size(); ++k)
        state.sent[k] = scattered_quanta(run.patches, k, [&](std::size_t at) {
            return run.banks.received(at / state.bands,
                                      static_cast<std::uint32_t>(at % state.bands));
        });
    return result;
}

}  // namespace parallux
