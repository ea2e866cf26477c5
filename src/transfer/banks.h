#pragma once

#include <cstdint>
#include <vector>

#include "parallux/transfer.h"

namespace parallux {

/// What all workers have received, and the totals of each. Every worker has a bank of its own while
/// memory allows; beyond that all share one, so that memory does not grow with threads × patches:
/// pairs then go through a Partition, single additions are atomic.
class Banks {
public:
    /// At most `allowed` bytes in all, or one bank.
    Banks(std::size_t patches, std::uint32_t bands, unsigned workers, std::uint64_t allowed);

    Bank& of(unsigned worker) { return banks_[worker % banks_.size()]; }
    bool shared() const { return banks_.size() < totals_.size(); }
    WorkerTotals& totals(unsigned worker) { return totals_[worker]; }
    /// Adds to one value of a worker's bank, k = patch * bands + band.
    void receive(unsigned worker, std::size_t k, std::int64_t quanta);
    /// Counts a line that leaves a patch.
    void leave(unsigned worker, std::size_t patch);

    /// What a patch has received in all banks, and how many lines left it.
    std::int64_t received(std::size_t patch, std::uint32_t band) const;
    std::int64_t exits(std::size_t patch) const { return received(patch, bands_); }
    /// Moves the totals of what came in from outside the exchange, of what escaped, and of what
    /// mirrors and glass absorbed.
    void take_totals(std::vector<std::int64_t>& came_in, std::vector<std::int64_t>& escaped,
                     std::vector<std::int64_t>& absorbed);
    /// Multiplies all that was received.
    void scale(double factor);
    /// Sets a patch's values to 0 in all banks.
    void clear_patch(std::size_t patch);
    /// Sets all values to 0.
    void clear(unsigned threads);
    /// Moves all that was received, and the workers' totals, to the first worker's.
    void collect(unsigned threads);
    /// All that they hold, to be written or read; for writing it must have been collected.
    template <class Archive>
    void fields(Archive& a) {
        a(banks_[0].received), a(totals_[0].escaped), a(totals_[0].sky), a(totals_[0].lost);
        fields_of(a, totals_[0].counts);
    }
    bool sound() const {
        return banks_[0].received.size() == patches_ * lanes(bands_) &&
               totals_[0].escaped.size() == max_bands && totals_[0].sky.size() == max_bands &&
               totals_[0].lost.size() == max_bands;
    }
    /// Leaves one bank, which holds the sum of all, and gives the others' memory back.
    void join(unsigned threads);

    std::size_t patches() const { return patches_; }
    std::uint32_t bands() const { return bands_; }
    const std::vector<Bank>& banks() const { return banks_; }
    std::vector<WorkerTotals>& all_totals() { return totals_; }

    static std::uint64_t bytes_a_bank(std::size_t patches, std::uint32_t bands) {
        return patches * lanes(bands) * sizeof(std::int64_t);
    }
    static unsigned count(std::size_t patches, std::uint32_t bands, unsigned workers,
                          std::uint64_t allowed);

private:
    void add(unsigned worker, std::size_t lane, std::int64_t value);

    std::size_t patches_;
    std::uint32_t bands_;
    std::vector<Bank> banks_;
    std::vector<WorkerTotals> totals_;
};

}  // namespace parallux
