#include "view_factors/pair_counts.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel.h"
#include "view_factors/expected_lines.h"

namespace parallux {

namespace {

// So that the entries of a shard stay in cache while they are sorted, and workers have enough.
constexpr std::size_t most_shards = 64;

unsigned row_bits_of(std::size_t nodes) {
    return static_cast<unsigned>(std::bit_width((nodes + most_shards - 1) / most_shards - 1));
}

}  // namespace

PairCounts::PairCounts(std::size_t nodes, std::uint32_t outsides, unsigned threads)
    : outsides_(outsides),
      row_bits_(row_bits_of(nodes)),
      packing_(row_bits_),
      lists_(threads),
      adders_(threads),
      shards_(((nodes - 1) >> row_bits_) + 1),
      outside_(nodes * outsides, 0),
      exits_(nodes, 0),
      squares_(nodes, 0) {
    for (std::vector<double>* sums : {&outside_shares_.sum, &outside_shares_.squares})
        sums->assign(nodes * outsides, 0);
    for (std::vector<double>* sums : {&sky_shares_.sum, &sky_shares_.squares})
        sums->assign(nodes, 0);
    for (Lists& lists : lists_) {
        lists.shard.resize(shards_.size());
        lists.ended.resize(shards_.size(), 0);
    }
}

// Sums what left each node in the bundle, and weighs it.
void PairCounts::find_weights(unsigned first, unsigned last, const std::vector<double>& expected) {
    parallel_for(last - first, last - first, 1, [&](std::size_t begin, std::size_t, unsigned) {
        Lists& lists = lists_[first + begin];
        lists.met.assign(nodes(), 0);
        for (std::size_t shard = 0; shard < shards_.size(); ++shard)
            for (std::size_t k = lists.ended[shard]; k < lists.shard[shard].size(); ++k) {
                const std::uint64_t entry = lists.shard[shard][k];
                const std::uint32_t column = PackedCount::column(entry);
                lists.met[shard * shard_nodes() + packing_.row(entry)] += packing_.count(entry);
                if (column < nodes())
                    lists.met[column] += packing_.count(entry);
            }
    });
    std::vector<double>& weight = lists_[first].weight;
    weight.resize(nodes());
    for (std::size_t node = 0; node < nodes(); ++node) {
        std::uint64_t met = 0;
        for (unsigned worker = first; worker < last; ++worker)
            met += lists_[worker].met[node];
        weight[node] =
            line_weight(expected[node], static_cast<double>(met) / static_cast<double>(line));
    }
}

void PairCounts::end_bundle(unsigned first, unsigned last, const std::vector<double>& expected) {
    if (!expected.empty())
        find_weights(first, last, expected);
    const std::vector<double>& weight = lists_[first].weight;
    auto weigh = [&](Lists& lists, std::size_t shard) {
        std::vector<std::uint64_t>& list = lists.shard[shard];
        const std::size_t end = list.size();
        for (std::size_t k = lists.ended[shard]; k < end; ++k) {
            const std::uint32_t row = packing_.row(list[k]), j = PackedCount::column(list[k]);
            const double own = weight[shard * shard_nodes() + row];
            const double w = j < nodes() ? std::sqrt(own * weight[j]) : own;
            const auto count =
                static_cast<std::uint64_t>(static_cast<double>(packing_.count(list[k])) * w + 0.5);
            list[k] = packing_.pack(row, j, std::min(count, packing_.most()));
            if (count > packing_.most())
                append(list, row, j, count - packing_.most());
        }
    };
    parallel_for(last - first, last - first, 1, [&](std::size_t begin, std::size_t, unsigned) {
        Lists& lists = lists_[first + begin];
        for (std::size_t shard = 0; shard < shards_.size(); ++shard) {
            if (!expected.empty())
                weigh(lists, shard);
            lists.ended[shard] = lists.shard[shard].size();
        }
    });
}

std::uint64_t PairCounts::listed() const {
    std::uint64_t sum = 0;
    for (const Lists& lists : lists_)
        for (const std::vector<std::uint64_t>& list : lists.shard)
            sum += list.size();
    return sum;
}

std::uint64_t PairCounts::enough() const {
    constexpr std::uint64_t least = std::uint64_t(1) << 20;
    std::uint64_t sum = 0;
    for (const Shard& shard : shards_)
        sum += shard.current.column.size();
    return std::max(least, sum / 2);
}

void PairCounts::apply(unsigned threads) {
    parallel_for(
        threads, shards_.size(), 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
            std::vector<const std::vector<std::uint64_t>*> lists(lists_.size());
            for (std::size_t shard = begin; shard < end; ++shard) {
                for (std::size_t k = 0; k < lists.size(); ++k)
                    lists[k] = &lists_[k].shard[shard];
                CountRows& rows = shards_[shard].current;
                rows.start.resize(std::min(shard_nodes(), nodes() - shard * shard_nodes()) + 1,
                                  rows.start.back());
                adders_[worker].add(lists, packing_, nodes() + outsides_, rows);
                for (Lists& own : lists_) {
                    own.shard[shard].clear();
                    own.ended[shard] = 0;
                }
            }
        });
}

// Calls visit(node, column, count).
template <class Visit>
void PairCounts::each_row(std::size_t shard, const CountRows& rows, Visit&& visit) const {
    for (std::size_t row = 0; row < rows.rows(); ++row)
        for (std::uint64_t k = rows.start[row]; k < rows.start[row + 1]; ++k)
            visit(shard * shard_nodes() + row, rows.column[k], rows.count[k]);
}

// What left each node in the group, and the squares of its pairs. A line that leaves a node and
// ends at the same one left it twice.
void PairCounts::sum_rows(unsigned threads, std::vector<std::uint64_t>& exits) {
    const auto few = static_cast<unsigned>((std::size_t(1) << 26) / (nodes() + 1) + 1);
    const unsigned workers = std::min(threads, few);
    std::vector<std::vector<std::uint64_t>> sums(workers);
    std::vector<std::vector<double>> squares(workers);
    parallel_for(workers, shards_.size(), 1,
                 [&](std::size_t begin, std::size_t end, unsigned worker) {
                     sums[worker].resize(nodes(), 0);
                     squares[worker].resize(nodes(), 0);
                     for (std::size_t shard = begin; shard < end; ++shard)
                         each_row(shard, shards_[shard].current,
                                  [&](std::size_t i, std::size_t j, std::uint64_t count) {
                                      sums[worker][i] += count;
                                      if (j >= nodes())
                                          return;
                                      sums[worker][j] += count;
                                      const double square =
                                          static_cast<double>(count) * static_cast<double>(count);
                                      squares[worker][i] += square;
                                      squares[worker][j] += square;
                                  });
                 });
    for (unsigned worker = 0; worker < workers; ++worker)
        for (std::size_t node = 0; node < sums[worker].size(); ++node) {
            exits[node] += sums[worker][node];
            squares_[node] += squares[worker][node];
        }
}

void PairCounts::take_shares(unsigned threads, const std::vector<std::uint64_t>& exits) {
    auto take = [&](std::size_t shard) {
        std::vector<double> sky(shard_nodes(), 0);
        each_row(
            shard, shards_[shard].current, [&](std::size_t i, std::size_t j, std::uint64_t count) {
                if (j < nodes())
                    return;
                const std::size_t k = j - nodes(), at = i * outsides_ + k;
                const double share = static_cast<double>(count) / static_cast<double>(exits[i]);
                outside_shares_.sum[at] += share;
                outside_shares_.squares[at] += share * share;
                outside_[at] += count;
                sky[i & (shard_nodes() - 1)] += k + 2 < outsides_ ? share : 0;
            });
        const std::size_t first = shard * shard_nodes();
        for (std::size_t i = first; i < std::min(first + shard_nodes(), nodes()); ++i) {
            sky_shares_.sum[i] += sky[i - first];
            sky_shares_.squares[i] += sky[i - first] * sky[i - first];
        }
    };
    parallel_for(threads, shards_.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t shard = begin; shard < end; ++shard) {
            take(shard);
            RowAdder::merge(shards_[shard].current, static_cast<std::uint32_t>(nodes()),
                            shards_[shard].before);
            shards_[shard].current = {};
        }
    });
}

void PairCounts::end_group(unsigned threads) {
    apply(threads);
    std::vector<std::uint64_t> exits(nodes(), 0);
    sum_rows(threads, exits);
    take_shares(threads, exits);
    for (std::size_t node = 0; node < nodes(); ++node)
        exits_[node] += exits[node];
    ++groups_;
}

std::uint64_t PairCounts::pairs() const {
    std::uint64_t pairs = 0;
    for (std::size_t shard = 0; shard < shards_.size(); ++shard) {
        pairs += shards_[shard].before.column.size();
        if (groups_ == 0)
            each_row(shard, shards_[shard].current,
                     [&](std::size_t, std::size_t j, std::uint64_t) { pairs += j < nodes(); });
    }
    return pairs;
}

std::uint64_t PairCounts::bytes() const {
    std::uint64_t bytes = 0;
    for (const Shard& shard : shards_)
        bytes += shard.current.bytes() + shard.before.bytes();
    for (const RowAdder& adder : adders_)
        bytes += adder.bytes();
    for (const Lists& lists : lists_) {
        bytes += (lists.met.capacity() + lists.weight.capacity()) * sizeof(std::uint64_t);
        for (const std::vector<std::uint64_t>& list : lists.shard)
            bytes += list.capacity() * sizeof(std::uint64_t);
    }
    return bytes;
}

}  // namespace parallux
