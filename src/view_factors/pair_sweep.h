#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "parallux/factors.h"
#include "view_factors/expected_lines.h"
#include "view_factors/nodes.h"
#include "view_factors/pair_counts.h"
#include "view_factors/sky_parts.h"

namespace parallux {

/// Sends line bundles through the scene and counts which nodes face each other on them, with the
/// weights of line_weight() but in scenes that repeat. Keeps references to all.
class PairSweep {
public:
    PairSweep(const Scene& scene, const Patches& patches, const NodeMap& nodes, const SkyDome& dome,
              unsigned threads, PairCounts& counts);
    ~PairSweep();

    /// Follows bundles first … first + count - 1 of a lattice. Some counts may still stand in
    /// lists.
    void bundles(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    /// Bundles that are worth to be followed at once; where the scene repeats, each has copies of
    /// its own.
    static std::uint32_t bundles_at_once(const Scene& scene, unsigned threads);
    std::uint32_t at_once() const { return bundles_at_once(scene_, threads_); }

    const LineCounts& line_counts() const { return line_counts_; }

private:
    struct Buffers;
    template <class Follow>
    void in_rounds(const std::vector<std::size_t>& tiles, Follow&& follow);
    void follow_alone(const Bundle& bundle, unsigned worker);
    void follow_together(const Bundle& bundle);
    void one_tile(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    void repeated(const BundleSettings& lattice, std::uint64_t first, std::uint32_t count);
    void count_tile(const glm::dvec3& direction, unsigned worker);
    void take_up();

    const Scene& scene_;
    const Patches& patches_;
    const NodeMap& nodes_;
    const SkyDome& dome_;
    unsigned threads_;
    PairCounts& counts_;
    Projector projector_;
    ExpectedLines expected_;
    std::vector<Buffers> buffers_;
    double entries_a_tile_ = 0;
    LineCounts line_counts_;
};

}  // namespace parallux
