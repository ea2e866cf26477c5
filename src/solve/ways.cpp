#include "solve/ways.h"

#include <algorithm>
#include <array>
#include <utility>

#include "parallel.h"
#include "random.h"
#include "transfer/for_bands.h"

namespace parallux {

void RegionWays::add_neighbours(const std::vector<double>& values, std::uint32_t bands,
                                unsigned threads, std::vector<double>& sums) const {
    for_bands(bands, [&](auto constant) {
        constexpr std::size_t count = constant();
        parallel_for(threads, regions(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t from = begin; from < end; ++from) {
                std::array<double, count> sum{};
                for (std::uint32_t k = start[from]; k < start[from + 1]; ++k)
                    for (std::size_t band = 0; band < count; ++band)
                        sum[band] += values[to[k] * count + band];
                for (std::size_t band = 0; band < count; ++band)
                    sums[from * count + band] += sum[band];
            }
        });
    });
}

Ways::Ways(const Regions& regions, unsigned threads) : regions_(regions), kept_(threads) {
}

void Ways::keep(const TilePairs& pairs, std::uint64_t salt, unsigned worker) {
    Kept& kept = kept_[worker];
    // Chosen by what a pair is, not by its place: tiles are listed in an order of the processor's.
    auto chosen = [&](std::uint64_t key) {
        return stride_ == 1 || mix64(key ^ salt) % stride_ == 0;
    };
    for (std::size_t k = 0; k < pairs.from.count; ++k)
        if (std::uint64_t a = pairs.from.ids[k], b = pairs.to.ids[k]; chosen(a << 32 | b))
            kept.pairs.push_back(std::uint64_t(regions_.of[a]) << 32 | regions_.of[b]);
    std::uint64_t list = 0;
    for (const PatchList* out : {&pairs.first, &pairs.last, &pairs.into_backs, &pairs.from_backs}) {
        --list;
        for (std::size_t k = 0; k < out->count; ++k)
            if (chosen(list << 32 | out->ids[k]))
                kept.out.push_back(regions_.of[out->ids[k]]);
    }
}

void Ways::collect() {
    for (std::size_t worker = 1; worker < kept_.size(); ++worker) {
        Kept moved = std::exchange(kept_[worker], {});
        kept_[0].pairs.insert(kept_[0].pairs.end(), moved.pairs.begin(), moved.pairs.end());
        kept_[0].out.insert(kept_[0].out.end(), moved.out.begin(), moved.out.end());
    }
}

bool Ways::sound() const {
    auto known = [&](std::uint64_t region) { return region < regions_.count; };
    return std::all_of(kept_.begin(), kept_.end(), [&](const Kept& kept) {
        return std::all_of(kept.out.begin(), kept.out.end(), known) &&
               std::all_of(kept.pairs.begin(), kept.pairs.end(), [&](std::uint64_t pair) {
                   return known(pair >> 32) && known(pair & 0xffffffffu);
               });
    });
}

template <class Visit>
void Ways::for_ends(Visit&& visit) const {
    for (const Kept& kept : kept_)
        for (std::uint64_t pair : kept.pairs) {
            const auto a = static_cast<std::uint32_t>(pair >> 32);
            const auto b = static_cast<std::uint32_t>(pair);
            visit(a, b);
            visit(b, a);
        }
}

GroupWays Ways::between_groups() const {
    GroupWays ways{regions_.groups, {}, {}};
    ways.lines.resize(std::size_t(ways.groups) * ways.groups, 0);
    ways.exits.resize(ways.groups, 0);
    for_ends([&](std::uint32_t from, std::uint32_t to) {
        const std::size_t group = regions_.group[from];
        ++ways.lines[group * ways.groups + regions_.group[to]];
        ++ways.exits[group];
    });
    for (const Kept& kept : kept_)
        for (std::uint32_t region : kept.out)
            ++ways.exits[regions_.group[region]];
    return ways;
}

RegionWays Ways::between_regions() const {
    RegionWays ways;
    ways.start.resize(regions_.count + 1, 0);
    for_ends([&](std::uint32_t from, std::uint32_t) { ++ways.start[from + 1]; });
    for (std::size_t region = 0; region < regions_.count; ++region)
        ways.start[region + 1] += ways.start[region];
    ways.to.resize(ways.start.back());
    std::vector<std::uint32_t> next(ways.start.begin(), ways.start.end() - 1);
    for_ends([&](std::uint32_t from, std::uint32_t to) { ways.to[next[from]++] = to; });
    for (std::size_t region = 0; region < regions_.count; ++region) {
        std::sort(ways.to.begin() + ways.start[region], ways.to.begin() + next[region]);
        next[region] -= ways.start[region];
    }
    ways.exits = std::move(next);
    for (const Kept& kept : kept_)
        for (std::uint32_t region : kept.out)
            ++ways.exits[region];
    return ways;
}

}  // namespace parallux
