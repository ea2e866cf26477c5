#include "solve/global_pass.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "parallel.h"
#include "random.h"
#include "transfer/partition.h"

namespace parallux {

namespace {

// A worker's buffers, kept from tile to tile; no two workers write to one cache line.
struct alignas(64) Buffers {
    std::shared_ptr<Projector::Workspace> workspace;
    IntersectionLists lists;
    TilePairs pairs;
    std::vector<glm::dvec3> directions;
    std::vector<SkyQuanta> sky;
};

class Pass {
public:
    Pass(const Run& run, const TransferState& state)
        : scene_(run.scene),
          patches_(run.patches),
          rays_(run.rays),
          settings_(run.settings),
          plan_(run.plan),
          state_(state),
          banks_(run.banks),
          buffers_(run.plan.threads),
          lit_(run.scene.sky.kind != Sky::Kind::dark),
          projector_(run.scene, run.patches) {
        for (Buffers& buffers : buffers_)
            buffers.workspace = projector_.make_workspace();
        if (banks_.shared())
            partition_.emplace(patches_.count(), patches_.bands, plan_.threads);
    }

    // Projects bundles and follows their tiles.
    void bundles(std::uint64_t first, std::uint32_t count) {
        if (scene_.surfaces.size() > many_surfaces)
            one_by_one(first, count);
        else if (count >= 4 * plan_.threads && !partition_)
            whole_bundles(first, count);
        else
            side_by_side(first, count);
    }

    // Traces independent lines first … first + count - 1 and follows them.
    void lines(std::uint64_t first, std::uint64_t count) {
        parallel_for(
            plan_.threads, count, 1024, [&](std::size_t begin, std::size_t end, unsigned worker) {
                Buffers& buffers = buffers_[worker];
                trace_lines(*rays_, scene_, patches_, plan_.sphere, settings_.seed, first + begin,
                            end - begin, buffers.lists, lit_ ? &buffers.directions : nullptr);
                buffers.sky.clear();
                for (std::size_t k = 0; lit_ && k < buffers.directions.size(); ++k)
                    buffers.sky.push_back(sky_quanta(scene_, plan_, state_, buffers.directions[k]));
                exchange(buffers.lists, state_, settings_.direction, buffers.sky, banks_.of(worker),
                         banks_.shared(), banks_.totals(worker));
            });
    }

    void darken_sky() { lit_ = false; }

private:
    // Of large scenes, a bundle is work for all threads, and one projection memory enough.
    static constexpr std::size_t many_surfaces = 1 << 13;

    Bundle bundle(std::uint64_t index) const {
        return make_bundle({settings_.seed, plan_.bundles, settings_.directions, plan_.spacing},
                           index);
    }

    void one_by_one(std::uint64_t first, std::uint32_t count) {
        projections_.resize(1);
        for (std::uint32_t k = 0; k < count; ++k) {
            projector_.project(bundle(first + k), projections_[0], plan_.threads);
            each_tile(projections_[0].tiles(), [&](std::size_t tile, unsigned worker) {
                follow_tile(projections_[0], tile, worker);
            });
        }
    }

    // Bundles enough for all threads: each takes one after the other from end to end.
    void whole_bundles(std::uint64_t first, std::uint32_t count) {
        projections_.resize(std::max<std::size_t>(projections_.size(), plan_.threads));
        parallel_for(plan_.threads, count, 1,
                     [&](std::size_t begin, std::size_t end, unsigned worker) {
                         for (std::size_t k = begin; k < end; ++k) {
                             projector_.project(bundle(first + k), projections_[worker]);
                             for (std::size_t tile = 0; tile < projections_[worker].tiles(); ++tile)
                                 follow_tile(projections_[worker], tile, worker);
                         }
                     });
    }

    // Projects the bundles first, then follows the tiles of all of them.
    void side_by_side(std::uint64_t first, std::uint32_t count) {
        projections_.resize(std::max<std::size_t>(projections_.size(), count));
        parallel_for(plan_.threads, count, 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k)
                projector_.project(bundle(first + k), projections_[k]);
        });
        std::vector<std::size_t> tiles_before(count + 1, 0);
        for (std::uint32_t k = 0; k < count; ++k)
            tiles_before[k + 1] = tiles_before[k] + projections_[k].tiles();
        each_tile(tiles_before.back(), [&](std::size_t tile, unsigned worker) {
            std::size_t k = static_cast<std::size_t>(
                std::upper_bound(tiles_before.begin(), tiles_before.end(), tile) -
                tiles_before.begin() - 1);
            follow_tile(projections_[k], tile - tiles_before[k], worker);
        });
    }

    // Tiles in parallel; where workers share a bank, in rounds, each added up before the next.
    template <class Follow>
    void each_tile(std::size_t tiles, Follow&& follow) {
        const std::size_t round = partition_ ? partition_->tiles_a_round() : tiles;
        for (std::size_t first = 0; first < tiles; first += round) {
            parallel_for(plan_.threads, std::min(round, tiles - first), 1,
                         [&](std::size_t begin, std::size_t end, unsigned worker) {
                             for (std::size_t tile = first + begin; tile < first + end; ++tile)
                                 follow(tile, worker);
                         });
            if (partition_)
                partition_->apply(state_, banks_.of(0), plan_.threads);
        }
    }

    void follow_tile(const Projection& projection, std::size_t tile, unsigned worker) {
        Buffers& buffers = buffers_[worker];
        projector_.pairs(projection, tile, *buffers.workspace, buffers.pairs);
        SkyQuanta sky;
        if (lit_)
            sky = sky_quanta(scene_, plan_, state_, projection.bundle.direction);
        if (partition_)
            partition_->put(worker, buffers.pairs, state_, settings_.direction,
                            lit_ ? &sky : nullptr, banks_.totals(worker));
        else
            exchange_pairs(buffers.pairs, state_, settings_.direction, lit_ ? &sky : nullptr,
                           banks_.of(worker), banks_.totals(worker));
    }

    const Scene& scene_;
    const Patches& patches_;
    const RayScene* rays_;
    const SolveSettings& settings_;
    const Plan& plan_;
    const TransferState& state_;
    Banks& banks_;
    std::vector<Buffers> buffers_;
    bool lit_;
    Projector projector_;
    std::optional<Partition> partition_;  // where the workers share a bank
    std::vector<Projection> projections_;
};

// Bundles whose emission is still unshot: how far the reflected light lags behind, in the band
// where it lags most. Band totals are integers, so that this is the same on any number of threads.
double lag(const TransferState& state, std::uint64_t done) {
    double most = 0;
    for (std::uint32_t band = 0; band < state.bands; ++band) {
        double sent = static_cast<double>(state.emitted[band] + state.sky[band]);
        double finished = static_cast<double>(state.absorbed[band] + state.escaped[band]);
        if (sent > 0)
            most = std::max(most, (sent - finished) / sent * static_cast<double>(done));
    }
    return most;
}

// How many bundles work from the next snapshot. A bounce takes about two batches: batches grow to
// the wanted size while the light keeps up, shrink where it lags by more than 1/32 of the run
// (white walls, narrow gaps), and shrink towards the end, so that little is left unshot there.
std::uint32_t next_batch(const Plan& plan, double lagging, std::uint64_t done, std::uint32_t last) {
    std::uint64_t emitting = plan.bundles - plan.closing;
    if (done >= emitting)
        return 1;
    bool behind = lagging > static_cast<double>(plan.bundles) / 32;
    std::uint64_t wanted = behind ? last / 2 : std::min(2 * last, plan.batch);
    std::uint64_t left = emitting - done;
    wanted = std::min(wanted, left / 8);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, left));
}

}  // namespace

PassResult global_pass(const Run& run, DirectLight& direct, TransferState& state) {
    const Plan& plan = run.plan;
    const bool bundles = run.settings.method == Method::bundles;
    settle(run, direct);
    state.emission = emission_of(run, direct);
    state.watts_per_quantum = carried_quantum(run, state.emission);
    state.dither = static_cast<std::uint32_t>(mix64(run.settings.seed));
    Pass pass(run, state);
    PassResult result;
    std::vector<double> planned;
    for (std::int64_t quanta : direct.unshot)
        planned.push_back(static_cast<double>(quanta) * plan.watts_per_quantum);
    result.leftover.emplace(run.scene, run.patches, planned, plan.threads);
    const std::uint64_t emitting = plan.bundles - plan.closing;
    const std::uint64_t halfway = emitting + plan.closing / 2;
    // What the next batch's exits carry is set by the merge before it, in one walk over the
    // patches: its size goes by the light that the merge before that has seen.
    std::uint32_t batch = next_batch(plan, 0, 0, 1);
    auto merge_for = [&](std::uint32_t next) {
        const bool emits = result.bundles < emitting;
        merge(state, run.patches, run.banks.banks(), run.banks.all_totals(),
              {plan.cell, next, emits ? emission_quanta(plan, state) : 0}, plan.threads);
    };
    merge_for(batch);
    while (result.bundles < plan.bundles) {
        // Emission ends before the lines do; what still goes round tells what is left over.
        if (plan.closing > 1 && (result.bundles == emitting || result.bundles == halfway))
            result.leftover->note(run.banks);
        if (result.bundles == emitting)
            pass.darken_sky();
        if (bundles) {
            pass.bundles(result.bundles, batch);
        } else {
            std::uint64_t first = result.bundles * plan.lines_a_unit;
            std::uint64_t end = std::min(plan.lines, first + batch * plan.lines_a_unit);
            pass.lines(first, end - first);
        }
        for (WorkerTotals& totals : run.banks.all_totals())
            result.counts += std::exchange(totals.counts, {});
        const double behind = lag(state, result.bundles);
        result.bundles += batch;
        batch = next_batch(plan, behind, result.bundles, batch);
        merge_for(batch);
        if (!run.listener.go_on(
                bundles ? "bundles" : "lines",
                static_cast<double>(result.bundles) / static_cast<double>(plan.bundles),
                result.counts.lines))
            break;
    }
    result.done =
        std::min(1.0, static_cast<double>(result.bundles) / static_cast<double>(emitting));
    result.whole = result.bundles == plan.bundles;
    if (result.whole && plan.closing > 1)
        result.leftover->note(run.banks);
    return result;
}

}  // namespace parallux
