#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace parallux {

/// Counts by rows, columns ascending, none of them 0.
struct CountRows {
    std::vector<std::uint64_t> start{0};
    std::vector<std::uint32_t> column;
    std::vector<std::uint64_t> count;

    std::size_t rows() const { return start.size() - 1; }
    std::uint64_t bytes() const;
};

/// A count of a row and a column in 64 bits, for rows below 2^row_bits ≤ 2^26.
class PackedCount {
public:
    explicit PackedCount(unsigned row_bits) : row_bits_(row_bits) {}

    std::uint64_t most() const { return (std::uint64_t(1) << (32 - row_bits_)) - 1; }
    std::uint64_t pack(std::uint32_t row, std::uint32_t column, std::uint64_t count) const {
        return (count << row_bits_ | row) << 32 | column;
    }
    std::uint32_t row(std::uint64_t packed) const {
        return static_cast<std::uint32_t>(packed >> 32) & ((1u << row_bits_) - 1);
    }
    static std::uint32_t column(std::uint64_t packed) { return static_cast<std::uint32_t>(packed); }
    std::uint64_t count(std::uint64_t packed) const { return packed >> (32 + row_bits_); }

private:
    unsigned row_bits_;
};

/// Adds packed counts to rows, through one row at a time that is not sparse: two marks for each
/// 64 columns and each 64 of these find again in order what was met. Scratch of one thread.
class RowAdder {
public:
    /// `rows` gets what `lists` hold on top of its own; time is linear in both.
    void add(const std::vector<const std::vector<std::uint64_t>*>& lists, PackedCount packing,
             std::size_t columns, CountRows& rows);
    /// `rows` gets the columns of `more` below `columns` on top of its own; both have equally many
    /// rows, or `rows` none.
    static void merge(const CountRows& more, std::uint32_t columns, CountRows& rows);
    std::uint64_t bytes() const;

private:
    void put(std::uint32_t column, std::uint64_t count) {
        dense_[column] += count;
        words_[column >> 6] |= std::uint64_t(1) << (column & 63);
        marks_[column >> 12] |= std::uint64_t(1) << (column >> 6 & 63);
    }
    void take(CountRows& rows);
    void sort_by_row(const std::vector<const std::vector<std::uint64_t>*>& lists,
                     PackedCount packing, std::size_t rows);

    std::vector<std::uint64_t> dense_, words_, marks_, sorted_, begin_;
    CountRows next_;
};

}  // namespace parallux
