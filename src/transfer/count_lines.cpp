#include "transfer/count_lines.h"

#include "transfer/for_bands.h"

namespace parallux {

namespace {

// Energy that meets nothing, or an inert back, goes no further.
template <std::uint32_t bands>
void escape(const PatchList& patches, const std::int32_t* carried, WorkerTotals& totals) {
    std::int64_t sums[bands] = {};
    for (std::size_t k = 0; k < patches.count; ++k)
        for (std::uint32_t band = 0; band < bands; ++band)
            sums[band] += carried[patches.ids[k] * std::size_t(lanes(bands)) + band];
    for (std::uint32_t band = 0; band < bands; ++band)
        totals.escaped[band] += sums[band];
}

void shine(const PatchList& patches, const std::int64_t* sky, std::uint32_t bands,
           WorkerTotals& totals) {
    for (std::uint32_t band = 0; band < bands; ++band)
        totals.sky[band] += sky[band] * static_cast<std::int64_t>(patches.count);
}

}  // namespace

void count_lines(const TilePairs& pairs, const TransferState& state, bool both_ways,
                 const SkyQuanta* sky, WorkerTotals& totals) {
    LineCounts& counts = totals.counts;
    counts.lines += pairs.lines;
    counts.nonempty += pairs.nonempty;
    counts.hits += pairs.hits;
    counts.odd += pairs.odd;
    counts.transfers += pairs.from.count;
    counts.met_backs += pairs.into_backs.count + (both_ways ? pairs.from_backs.count : 0);
    for_bands(state.bands, [&](auto bands) {
        const std::int32_t* carried = state.carried.data();
        escape<bands()>(pairs.last, carried, totals);
        escape<bands()>(pairs.into_backs, carried, totals);
        if (both_ways) {
            escape<bands()>(pairs.first, carried, totals);
            escape<bands()>(pairs.from_backs, carried, totals);
        }
    });
    if (sky)
        shine(pairs.first, sky->along, state.bands, totals);
    if (sky && both_ways)
        shine(pairs.last, sky->against, state.bands, totals);
}

}  // namespace parallux
