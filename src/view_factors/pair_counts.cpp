#include "view_factors/pair_counts.h"

#include <algorithm>

#include "parallel.h"

namespace parallux {

PairCounts::PairCounts(std::size_t nodes, std::uint32_t outsides, unsigned threads)
    : outsides_(outsides),
      buffers_(threads),
      tables_(shards),
      outside_(nodes * outsides, 0),
      outside_now_(nodes * outsides, 0),
      exits_(nodes, 0),
      squares_(nodes, 0) {
    for (std::vector<double>* sums : {&outside_shares_.sum, &outside_shares_.squares})
        sums->assign(nodes * outsides, 0);
    for (std::vector<double>* sums : {&sky_shares_.sum, &sky_shares_.squares})
        sums->assign(nodes, 0);
}

std::uint64_t PairCounts::buffered() const {
    std::uint64_t sum = 0;
    for (const Buffers& buffers : buffers_)
        for (const std::vector<Entry>& entries : buffers.shard)
            sum += entries.size();
    return sum;
}

void PairCounts::apply(unsigned threads) {
    parallel_for(threads, shards, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t shard = begin; shard < end; ++shard)
            apply_shard(static_cast<std::uint32_t>(shard));
    });
}

void PairCounts::apply_shard(std::uint32_t shard) {
    constexpr std::size_t ahead = 16;
    PairTable& table = tables_[shard];
    auto key = [](const Entry& e) { return std::uint64_t(e.i) << 32 | e.j; };
    for (Buffers& buffers : buffers_) {
        std::vector<Entry>& entries = buffers.shard[shard];
        for (std::size_t k = 0; k < entries.size(); ++k) {
            if (k + ahead < entries.size() && entries[k + ahead].j < nodes())
                table.announce(key(entries[k + ahead]));
            const Entry& e = entries[k];
            if (e.j < nodes())
                table.add(key(e), e.count);
            else
                outside_now_[e.i * std::size_t(outsides_) + (e.j - nodes())] += e.count;
        }
        entries.clear();
    }
}

// What left each node in the group, and the squares of its pairs. A line that leaves a node and
// ends at the same one left it twice.
void PairCounts::sum_rows(unsigned threads, std::vector<std::uint64_t>& exits) {
    const auto few = static_cast<unsigned>((std::size_t(1) << 26) / (nodes() + 1) + 1);
    const unsigned workers = std::min(threads, few);
    std::vector<std::vector<std::uint64_t>> sums(workers);
    std::vector<std::vector<double>> squares(workers);
    parallel_for(workers, shards, 1, [&](std::size_t begin, std::size_t end, unsigned worker) {
        sums[worker].resize(nodes(), 0);
        squares[worker].resize(nodes(), 0);
        for (std::size_t shard = begin; shard < end; ++shard)
            for (PairTable::Place& place : tables_[shard].places()) {
                if (place.key == PairTable::empty || place.current == 0)
                    continue;
                const auto count = static_cast<double>(place.current);
                for (std::size_t node : {place.key >> 32, place.key & 0xffffffffu}) {
                    sums[worker][node] += place.current;
                    squares[worker][node] += count * count;
                }
                place.before += place.current;
                place.current = 0;
            }
    });
    for (unsigned worker = 0; worker < workers; ++worker)
        for (std::size_t node = 0; node < sums[worker].size(); ++node) {
            exits[node] += sums[worker][node];
            squares_[node] += squares[worker][node];
        }
}

void PairCounts::take_shares(unsigned threads, const std::vector<std::uint64_t>& exits) {
    auto take = [&](std::size_t node) {
        const double each = exits[node] > 0 ? 1 / static_cast<double>(exits[node]) : 0;
        double sky = 0;
        for (std::uint32_t k = 0; k < outsides_; ++k) {
            std::uint64_t& now = outside_now_[node * outsides_ + k];
            const double share = each * static_cast<double>(now);
            outside_shares_.sum[node * outsides_ + k] += share;
            outside_shares_.squares[node * outsides_ + k] += share * share;
            outside_[node * outsides_ + k] += now;
            now = 0;
            sky += k + 2 < outsides_ ? share : 0;
        }
        sky_shares_.sum[node] += sky;
        sky_shares_.squares[node] += sky * sky;
    };
    parallel_for(threads, nodes(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t node = begin; node < end; ++node)
            take(node);
    });
}

void PairCounts::end_group(unsigned threads) {
    apply(threads);
    std::vector<std::uint64_t> exits(nodes(), 0);
    for (std::size_t k = 0; k < outside_now_.size(); ++k)
        exits[k / outsides_] += outside_now_[k];
    sum_rows(threads, exits);
    take_shares(threads, exits);
    for (std::size_t node = 0; node < nodes(); ++node)
        exits_[node] += exits[node];
    ++groups_;
}

PairCounts::Pairs PairCounts::pairs() {
    Pairs pairs;
    for (PairTable& table : tables_) {
        pairs.all += table.used();
        for (const PairTable::Place& place : table.places()) {
            pairs.once += place.key != PairTable::empty && place.current == 1;
            pairs.twice += place.key != PairTable::empty && place.current == 2;
        }
    }
    return pairs;
}

std::uint64_t PairCounts::table_bytes() const {
    std::uint64_t bytes = 0;
    for (const PairTable& table : tables_)
        bytes += table.bytes();
    return bytes;
}

}  // namespace parallux
