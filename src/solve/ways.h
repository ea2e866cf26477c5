#pragma once

#include <cstdint>
#include <vector>

#include "parallux/lines.h"
#include "solve/regions.h"

namespace parallux {

/// How power goes between groups of regions: that of a group leaves in even parts along its lines.
struct GroupWays {
    std::uint32_t groups = 0;
    std::vector<std::uint32_t> lines;  ///< between two groups, from · groups + to; symmetric, those
                                       ///< within a group twice
    std::vector<std::uint32_t> exits;  ///< lines that leave each group, to others or out
};

/// The same between regions.
struct RegionWays {
    std::vector<std::uint32_t> start;  ///< regions + 1
    std::vector<std::uint32_t> to;     ///< a region's neighbours, one for each line between them,
                                       ///< both ends apart; ascending, so that sums have one order
    std::vector<std::uint32_t> exits;

    std::size_t regions() const { return exits.size(); }
    /// sums[from] += Σ values[to], a band.
    void add_neighbours(const std::vector<double>& values, std::uint32_t bands, unsigned threads,
                        std::vector<double>& sums) const;
};

/// Lines kept for use after the bundles they came from. What is kept is a sample, so that memory
/// and time do not grow with the lines of the run. All that comes back is the same on any number of
/// threads.
class Ways {
public:
    Ways(const Regions& regions, unsigned threads);

    /// From now on keeps about one of so many pairs; 0: none.
    void keep_one_of(std::uint64_t stride) { stride_ = stride; }
    bool keeping() const { return stride_ > 0; }
    /// Keeps a share of the pairs of some lines, another for each salt; each worker by itself.
    void keep(const TilePairs& pairs, std::uint64_t salt, unsigned worker);

    /// All that is kept, to be written or read; for writing it must have been collected.
    void collect();
    template <class Archive>
    void fields(Archive& a) {
        a(kept_[0].pairs), a(kept_[0].out);
    }
    /// False where a region is none.
    bool sound() const;

    /// O(kept).
    GroupWays between_groups() const;
    /// O(kept log(kept / regions)).
    RegionWays between_regions() const;

private:
    struct alignas(64) Kept {
        std::vector<std::uint64_t> pairs;  // both regions, 32 bits each
        std::vector<std::uint32_t> out;    // regions that lines leave out of the scene
    };
    template <class Visit>
    void for_ends(Visit&& visit) const;

    const Regions& regions_;
    std::uint64_t stride_ = 0;
    std::vector<Kept> kept_;
};

}  // namespace parallux
