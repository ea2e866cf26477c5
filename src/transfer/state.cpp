#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel.h"
#include "parallux/transfer.h"

namespace parallux {

namespace {
constexpr std::size_t patches_a_piece = 4096;
}

TransferState dark_state(const Patches& patches, double watts_per_quantum) {
    std::size_t values = patches.count() * patches.bands;
    TransferState state;
    state.bands = patches.bands;
    state.watts_per_quantum = watts_per_quantum;
    for (auto* array : {&state.unshot, &state.received, &state.emission})
        array->assign(values, 0);
    state.quanta.assign(patches.count() * lanes(patches.bands), 0);
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        state.quanta[patch * lanes(patches.bands) + patches.bands] = 1;
    for (auto* totals : {&state.sky, &state.emitted, &state.absorbed, &state.escaped})
        totals->assign(patches.bands, 0);
    state.exits.assign(patches.count(), 0);
    return state;
}

void share_unshot(TransferState& state, const Patches& patches, double cell, std::uint32_t batch,
                  unsigned threads) {
    parallel_for(threads, patches.count(), patches_a_piece,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t patch = begin; patch < end; ++patch) {
                         // E[exits a bundle] · cell / area = |cos θ|: every direction gets its due.
                         double share = std::min(1.0, cell / patches.area[patch]) / batch;
                         std::int64_t* quanta = &state.quanta[patch * lanes(state.bands)];
                         for (std::size_t k = patch * state.bands; k < (patch + 1) * state.bands;
                              ++k)
                             *quanta++ = state.emission[k] +
                                         std::llrint(static_cast<double>(state.unshot[k]) * share);
                     }
                 });
}

void merge(TransferState& state, const Patches& patches, std::vector<Deltas>& deltas,
           std::vector<WorkerTotals>& totals, unsigned threads) {
    std::uint32_t bands = state.bands;
    std::size_t count = patches.count();
    std::size_t pieces = (count + patches_a_piece - 1) / patches_a_piece;
    std::vector<std::int64_t> absorbed(pieces * bands, 0), emitted(pieces * bands, 0);
    parallel_for(
        threads, count, patches_a_piece, [&](std::size_t begin, std::size_t end, unsigned) {
            std::size_t piece = begin / patches_a_piece * bands;
            for (std::size_t patch = begin; patch < end; ++patch) {
                std::int64_t exits = 0;
                std::int64_t received[max_bands] = {};
                const std::int64_t* quanta = &state.quanta[patch * lanes(bands)];
                for (Deltas& delta : deltas) {
                    std::int64_t* own = &delta.received[patch * lanes(bands)];
                    exits += std::exchange(own[bands], 0);
                    for (std::uint32_t band = 0; band < bands; ++band)
                        received[band] += std::exchange(own[band], 0);
                }
                state.exits[patch] += static_cast<std::uint64_t>(exits);
                for (std::uint32_t band = 0; band < bands; ++band) {
                    std::size_t k = patch * bands + band;
                    std::int64_t reflected =
                        std::llrint(static_cast<double>(patches.reflectance[k]) *
                                    static_cast<double>(received[band]));
                    // The emission was never part of unshot; only the share leaves it.
                    state.unshot[k] += reflected - exits * (quanta[band] - state.emission[k]);
                    state.received[k] += received[band];
                    absorbed[piece + band] += received[band] - reflected;
                    emitted[piece + band] += exits * state.emission[k];
                }
            }
        });
    for (std::size_t k = 0; k < absorbed.size(); ++k) {
        state.absorbed[k % bands] += absorbed[k];
        state.emitted[k % bands] += emitted[k];
    }
    for (WorkerTotals& worker : totals)
        for (std::uint32_t band = 0; band < bands; ++band) {
            state.escaped[band] += std::exchange(worker.escaped[band], 0);
            state.sky[band] += std::exchange(worker.sky[band], 0);
        }
}

}  // namespace parallux
