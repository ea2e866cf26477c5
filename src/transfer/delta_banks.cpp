#include "transfer/delta_banks.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace parallux {

unsigned DeltaBanks::count(std::size_t patches, std::uint32_t bands, unsigned workers,
                           std::uint64_t allowed) {
    std::uint64_t fit = allowed / std::max<std::uint64_t>(1, bytes_a_bank(patches, bands));
    return static_cast<unsigned>(std::clamp<std::uint64_t>(fit, 1, workers));
}

DeltaBanks::DeltaBanks(std::size_t patches, std::uint32_t bands, unsigned workers,
                       std::uint64_t allowed)
    : bands_(bands), banks_(count(patches, bands, workers, allowed)), totals_(workers) {
    for (Deltas& bank : banks_) {
        bank.received.assign(patches * lanes(bands), 0);
    }
}

void DeltaBanks::receive(unsigned worker, std::size_t k, std::int64_t quanta) {
    std::int64_t& target = of(worker).received[k / bands_ * lanes(bands_) + k % bands_];
    if (shared())
        std::atomic_ref<std::int64_t>(target).fetch_add(quanta, std::memory_order_relaxed);
    else
        target += quanta;
}

void DeltaBanks::collect(std::vector<std::int64_t>& received, std::vector<std::int64_t>& came_in,
                         std::vector<std::int64_t>& escaped) {
    for (Deltas& bank : banks_)
        for (std::size_t k = 0; k < received.size(); ++k)
            received[k] += std::exchange(bank.received[k / bands_ * lanes(bands_) + k % bands_], 0);
    for (WorkerTotals& worker : totals_)
        for (std::size_t band = 0; band < came_in.size(); ++band) {
            came_in[band] += std::exchange(worker.sky[band], 0);
            escaped[band] += std::exchange(worker.escaped[band], 0);
        }
}

}  // namespace parallux
