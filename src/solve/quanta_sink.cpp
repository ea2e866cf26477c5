#include "solve/quanta_sink.h"

namespace parallux {

QuantaSink bank_sink(const Run& run, unsigned worker) {
    const std::uint32_t bands = run.patches.bands;
    WorkerTotals& totals = run.banks.totals(worker);
    return {[&run, bands, worker](std::uint32_t patch, const Quanta& quanta) {
                for (std::uint32_t band = 0; band < bands; ++band)
                    run.banks.receive(worker, patch * std::size_t(bands) + band, quanta[band]);
            },
            [&totals, bands](const Quanta& quanta) {
                for (std::uint32_t band = 0; band < bands; ++band)
                    totals.escaped[band] += quanta[band];
            },
            [&totals, bands](const Quanta& quanta) {
                for (std::uint32_t band = 0; band < bands; ++band)
                    totals.lost[band] += quanta[band];
            }};
}

}  // namespace parallux
