#pragma once

#include <cstdint>
#include <vector>

#include "parallux/transfer.h"

namespace parallux {

/// The deltas of all workers. Each worker has its own bank while memory allows; beyond that several
/// share one and add atomically, so that memory does not grow with threads × patches.
class DeltaBanks {
public:
    /// At most `allowed` bytes in all, but always one bank.
    DeltaBanks(std::size_t patches, std::uint32_t bands, unsigned workers, std::uint64_t allowed);

    Deltas& of(unsigned worker) { return banks_[worker % banks_.size()]; }
    bool shared() const { return banks_.size() < totals_.size(); }
    WorkerTotals& totals(unsigned worker) { return totals_[worker]; }
    /// Adds to one value of a worker's bank.
    void receive(unsigned worker, std::size_t k, std::int64_t quanta);
    /// Moves all that was received, and the totals of what came in and escaped, out of the banks.
    void collect(std::vector<std::int64_t>& received, std::vector<std::int64_t>& came_in,
                 std::vector<std::int64_t>& escaped);

    std::vector<Deltas>& banks() { return banks_; }
    std::vector<WorkerTotals>& all_totals() { return totals_; }

    static std::uint64_t bytes_a_bank(std::size_t patches, std::uint32_t bands) {
        return patches * lanes(bands) * sizeof(std::int64_t);
    }
    static unsigned count(std::size_t patches, std::uint32_t bands, unsigned workers,
                          std::uint64_t allowed);

private:
    std::uint32_t bands_;
    std::vector<Deltas> banks_;
    std::vector<WorkerTotals> totals_;
};

}  // namespace parallux
