#include "transfer/banks.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "parallel.h"

namespace parallux {

unsigned Banks::count(std::size_t patches, std::uint32_t bands, unsigned workers,
                      std::uint64_t allowed) {
    return workers * bytes_a_bank(patches, bands) <= allowed ? workers : 1;
}

Banks::Banks(std::size_t patches, std::uint32_t bands, unsigned workers, std::uint64_t allowed)
    : patches_(patches),
      bands_(bands),
      banks_(count(patches, bands, workers, allowed)),
      totals_(workers) {
    for (Bank& bank : banks_)
        bank.received.assign(patches * lanes(bands), 0);
}

void Banks::add(unsigned worker, std::size_t lane, std::int64_t value) {
    std::int64_t& target = of(worker).received[lane];
    if (shared())
        std::atomic_ref<std::int64_t>(target).fetch_add(value, std::memory_order_relaxed);
    else
        target += value;
}

void Banks::receive(unsigned worker, std::size_t k, std::int64_t quanta) {
    add(worker, k / bands_ * lanes(bands_) + k % bands_, quanta);
}

void Banks::leave(unsigned worker, std::size_t patch) {
    add(worker, patch * lanes(bands_) + bands_, 1);
}

std::int64_t Banks::received(std::size_t patch, std::uint32_t band) const {
    std::int64_t sum = 0;
    for (const Bank& bank : banks_)
        sum += bank.received[patch * lanes(bands_) + band];
    return sum;
}

void Banks::take_totals(std::vector<std::int64_t>& came_in, std::vector<std::int64_t>& escaped,
                        std::vector<std::int64_t>& absorbed) {
    for (WorkerTotals& worker : totals_)
        for (std::uint32_t band = 0; band < bands_; ++band) {
            came_in[band] += std::exchange(worker.sky[band], 0);
            escaped[band] += std::exchange(worker.escaped[band], 0);
            absorbed[band] += std::exchange(worker.lost[band], 0);
        }
}

void Banks::scale(double factor) {
    for (std::size_t patch = 0; patch < patches_; ++patch) {
        std::int64_t scaled[max_bands];
        for (std::uint32_t band = 0; band < bands_; ++band)
            scaled[band] = std::llrint(static_cast<double>(received(patch, band)) * factor);
        clear_patch(patch);
        std::copy_n(scaled, bands_, &banks_[0].received[patch * lanes(bands_)]);
    }
}

void Banks::clear_patch(std::size_t patch) {
    for (Bank& bank : banks_)
        std::fill_n(&bank.received[patch * lanes(bands_)], lanes(bands_), 0);
}

void Banks::clear(unsigned threads) {
    parallel_for(threads, patches_, 1 << 14, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t patch = begin; patch < end; ++patch)
            clear_patch(patch);
    });
}

void Banks::collect(unsigned threads) {
    parallel_for(threads, banks_[0].received.size(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t other = 1; other < banks_.size(); ++other)
                         for (std::size_t k = begin; k < end; ++k)
                             banks_[0].received[k] += std::exchange(banks_[other].received[k], 0);
                 });
    for (std::size_t worker = 1; worker < totals_.size(); ++worker) {
        const WorkerTotals moved = std::exchange(totals_[worker], {});
        totals_[0].counts += moved.counts;
        for (std::uint32_t band = 0; band < bands_; ++band) {
            totals_[0].escaped[band] += moved.escaped[band];
            totals_[0].sky[band] += moved.sky[band];
            totals_[0].lost[band] += moved.lost[band];
        }
    }
}

void Banks::join(unsigned threads) {
    parallel_for(threads, banks_[0].received.size(), 1 << 14,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     for (std::size_t other = 1; other < banks_.size(); ++other)
                         for (std::size_t k = begin; k < end; ++k)
                             banks_[0].received[k] += banks_[other].received[k];
                 });
    banks_.resize(1);
}

}  // namespace parallux
