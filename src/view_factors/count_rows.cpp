#include "view_factors/count_rows.h"

#include <algorithm>

namespace parallux {

std::uint64_t CountRows::bytes() const {
    return start.capacity() * sizeof(std::uint64_t) +
           column.capacity() * (sizeof(std::uint32_t) + sizeof(std::uint64_t));
}

// Counts the entries of every row, and places them one row after the other.
void RowAdder::sort_by_row(const std::vector<const std::vector<std::uint64_t>*>& lists,
                           PackedCount packing, std::size_t rows) {
    begin_.assign(rows + 1, 0);
    for (const std::vector<std::uint64_t>* list : lists)
        for (std::uint64_t entry : *list)
            ++begin_[packing.row(entry)];
    std::uint64_t sum = 0;
    for (std::uint64_t& begin : begin_) {
        sum += begin;
        begin = sum;
    }
    sorted_.resize(sum);
    for (const std::vector<std::uint64_t>* list : lists)
        for (std::uint64_t entry : *list)
            sorted_[--begin_[packing.row(entry)]] = entry;
}

void RowAdder::take(CountRows& rows) {
    for (std::size_t m = 0; m < marks_.size(); ++m) {
        for (std::uint64_t mark = marks_[m]; mark != 0; mark &= mark - 1) {
            const std::size_t w = 64 * m + static_cast<std::size_t>(std::countr_zero(mark));
            for (std::uint64_t word = words_[w]; word != 0; word &= word - 1) {
                const std::size_t column =
                    64 * w + static_cast<std::size_t>(std::countr_zero(word));
                rows.column.push_back(static_cast<std::uint32_t>(column));
                rows.count.push_back(dense_[column]);
                dense_[column] = 0;
            }
            words_[w] = 0;
        }
        marks_[m] = 0;
    }
    rows.start.push_back(rows.column.size());
}

void RowAdder::add(const std::vector<const std::vector<std::uint64_t>*>& lists, PackedCount packing,
                   std::size_t columns, CountRows& rows) {
    dense_.resize(columns, 0);
    words_.resize((columns + 63) / 64, 0);
    marks_.resize((words_.size() + 63) / 64, 0);
    sort_by_row(lists, packing, rows.rows());
    next_.start.assign(1, 0);
    next_.column.clear();
    next_.count.clear();
    for (std::size_t row = 0; row < rows.rows(); ++row) {
        for (std::uint64_t k = rows.start[row]; k < rows.start[row + 1]; ++k)
            put(rows.column[k], rows.count[k]);
        for (std::uint64_t k = begin_[row]; k < begin_[row + 1]; ++k)
            put(PackedCount::column(sorted_[k]), packing.count(sorted_[k]));
        take(next_);
    }
    rows = next_;
}

void RowAdder::merge(const CountRows& more, std::uint32_t columns, CountRows& rows) {
    rows.start.resize(more.start.size(), rows.start.back());
    CountRows sum;
    sum.column.reserve(rows.column.size() + more.column.size());
    sum.count.reserve(rows.column.size() + more.column.size());
    for (std::size_t row = 0; row < more.rows(); ++row) {
        std::uint64_t a = rows.start[row], b = more.start[row];
        const std::uint64_t a_end = rows.start[row + 1], b_end = more.start[row + 1];
        while (a < a_end || (b < b_end && more.column[b] < columns)) {
            const std::uint32_t i = a < a_end ? rows.column[a] : columns;
            const std::uint32_t j = b < b_end ? more.column[b] : columns;
            sum.column.push_back(std::min(i, j));
            sum.count.push_back((i <= j ? rows.count[a++] : 0) + (j <= i ? more.count[b++] : 0));
        }
        sum.start.push_back(sum.column.size());
    }
    sum.column.shrink_to_fit();
    sum.count.shrink_to_fit();
    rows = std::move(sum);
}

std::uint64_t RowAdder::bytes() const {
    return next_.bytes() + sizeof(std::uint64_t) * (dense_.capacity() + words_.capacity() +
                                                    sorted_.capacity() + begin_.capacity());
}

}  // namespace parallux
