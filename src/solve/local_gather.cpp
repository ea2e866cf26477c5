#include "solve/local_gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "parallel.h"
#include "random.h"
#include "solve/emitters.h"
#include "solve/group.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

constexpr std::uint32_t paths = 64;

// What paths from small patches find.
class LocalPaths {
public:
    LocalPaths(const Run& run, const TransferState& state, const std::vector<SmallPatch>& small,
               const PassResult& pass)
        : run_(run),
          emission_(state.emission),
          pass_(pass),
          cells_(run.scene, run.patches, numbers_of(small)) {
        emission_.quanta = 1;
    }

    // Adds what arrives at the k-th small patch along one path, W/m² a band.
    void add_path(std::size_t k, Random& random, std::array<double, max_bands>& arrived) const {
        constexpr int longest = 64;
        const std::uint32_t bands = run_.patches.bands;
        std::array<double, max_bands> kept;
        kept.fill(1);
        for (int bounce = 0; bounce < longest; ++bounce) {
            const Emitter& from = cells_.choose(k, random.uniform());
            const double a = random.uniform(), b = random.uniform(), c = random.uniform(),
                         d = random.uniform();
            const EmitterPlace place = place_on(run_.scene, from, a, b);
            const glm::dvec3 direction = cosine_direction(place.normal, c, d);
            const SurfaceHit hit = run_.rays->closest(
                place.point, direction, std::numeric_limits<double>::infinity(), from.surface);
            if (hit.surface == none) {
                const Spectrum sky = run_.scene.sky.radiance(direction);
                for (std::uint32_t band = 0; band < bands; ++band)
                    arrived[band] += kept[band] * pi * sky[band];
                return;
            }
            const std::uint32_t patch = patch_of(run_.scene, run_.patches, hit);
            if (patch == none)
                return;
            // A small patch sends what it emits, and what another ray from it will find.
            const std::size_t next = bounce + 1 < longest ? cells_.find(patch) : cells_.count();
            for (std::uint32_t band = 0; band < bands; ++band) {
                const std::size_t at = std::size_t(patch) * bands + band;
                arrived[band] += kept[band] * emission_.of_exit(run_.patches, at);
                if (next == cells_.count())
                    arrived[band] +=
                        kept[band] * scattered(run_.patches, at, [&](std::size_t side) {
                            return pass_.irradiance[side];
                        });
            }
            if (next == cells_.count())
                return;
            k = cells_.find(go_on(patch, random, kept));
            if (k == cells_.count())
                return;
        }
    }

private:
    // What a patch sends came to it, or to its other side: chooses the side by the largest of the
    // shares that it sends of either, and returns its patch.
    std::uint32_t go_on(std::uint32_t patch, Random& random,
                        std::array<double, max_bands>& kept) const {
        const Patches& patches = run_.patches;
        const std::uint32_t bands = patches.bands;
        const std::uint32_t side = patches.translucent() ? patches.other[patch] : none;
        const float* rho = &patches.reflectance[patch * std::size_t(bands)];
        if (side == none) {
            for (std::uint32_t band = 0; band < bands; ++band)
                kept[band] *= static_cast<double>(rho[band]);
            return patch;
        }
        const float* tau = &patches.transmittance[side * std::size_t(bands)];
        const double most = *std::max_element(rho, rho + bands);
        const double through = *std::max_element(tau, tau + bands);
        const double here = most + through > 0 ? most / (most + through) : 1;
        const bool stays = random.uniform() < here;
        for (std::uint32_t band = 0; band < bands; ++band)
            kept[band] *= stays ? rho[band] / here : tau[band] / (1 - here);
        return stays ? patch : side;
    }

    const Run& run_;
    Emission emission_;
    const PassResult& pass_;
    PatchCells cells_;
};

}  // namespace

void gather_locally(const Run& run, Group& group) {
    std::vector<SmallPatch>& small = group.small;
    if (small.empty())
        return;
    const LocalPaths local(run, group.state, small, group.pass);
    auto gather = [&](SmallPatch& one, std::size_t k) {
        Random random(run.settings.seed, stream::local_gather + one.patch);
        for (std::uint32_t path = 0; path < paths; ++path)
            local.add_path(k, random, one.irradiance);
        for (double& irradiance : one.irradiance)
            irradiance /= paths;
    };
    // In slabs, so that the caller is heard now and then.
    constexpr std::uint64_t slab = 1 << 12;
    bool going_on = true;
    while (going_on && group.done < small.size()) {
        const std::uint64_t count = std::min(slab, small.size() - group.done);
        parallel_for(run.plan.threads, count, 4, [&](std::size_t begin, std::size_t end, unsigned) {
            DenormalsOff guard;
            for (std::size_t k = group.done + begin; k < group.done + end; ++k)
                gather(small[k], k);
        });
        group.done += count;
        going_on = run.listener.go_on(
            "bundles",
            static_cast<double>(run.plan.passing()) / static_cast<double>(run.plan.bundles),
            group.pass.counts.lines);
    }
    small.resize(group.done);
}

void shoot_locally(const Run& run, Group& group) {
    const std::vector<SmallPatch>& small = group.small;
    PassResult& pass = group.pass;
    if (small.empty() || !pass.whole)
        return;
    const Patches& patches = run.patches;
    const std::uint32_t bands = patches.bands;
    // What the paths have found, in place of what lines did. They do not count as crossings, by
    // which groups are weighted: patches are chosen by how bright a group takes them to be, and the
    // mean would lean to groups that err upwards.
    for (const SmallPatch& one : small)
        for (std::uint32_t band = 0; band < bands; ++band)
            pass.irradiance[one.patch * std::size_t(bands) + band] =
                static_cast<float>(one.irradiance[band]);
    // What they send, to all others: what they send each other the paths have brought.
    const std::vector<std::uint32_t> numbers = numbers_of(small);
    Emission emission = group.state.emission;
    emission.quanta = 1;
    const Emitters emitters = emitters_of(run.scene, patches, [&](std::size_t k) -> std::int64_t {
        const auto patch = static_cast<std::uint32_t>(k / bands);
        if (!std::binary_search(numbers.begin(), numbers.end(), patch))
            return 0;
        return std::llrint(patches.area[patch] * sent_by_exit(run, emission, pass, k) /
                           run.plan.watts_per_quantum);
    });
    if (emitters.pieces.empty())
        return;
    if (group.done == 0)
        run.banks.clear(run.plan.threads);
    const double done =
        shoot_rays(run, emitters, std::uint64_t(paths) * small.size(),
                   mix64(run.settings.seed ^ stream::local_gather), group.done,
                   [&](double) { return run.listener.go_on("bundles", 1, pass.counts.lines); });
    if (done < 1) {
        run.banks.scale(1 / done);
        pass.whole = false;
    }
    for (std::uint32_t patch = 0; patch < patches.count(); ++patch) {
        if (std::binary_search(numbers.begin(), numbers.end(), patch))
            continue;
        for (std::uint32_t band = 0; band < bands; ++band)
            pass.irradiance[patch * std::size_t(bands) + band] +=
                static_cast<float>(static_cast<double>(run.banks.received(patch, band)) *
                                   run.plan.watts_per_quantum / patches.area[patch]);
    }
    for (WorkerTotals& totals : run.banks.all_totals())
        totals = {};
}

}  // namespace parallux
