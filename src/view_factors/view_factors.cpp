#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "parallux/factors.h"
#include "view_factors/counting.h"
#include "view_factors/errors.h"
#include "view_factors/exchange_areas.h"
#include "view_factors/memory.h"
#include "view_factors/nodes.h"
#include "view_factors/pair_sweep.h"
#include "view_factors/plan.h"
#include "view_factors/sky_shares.h"

namespace parallux {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void add_warnings(const Scene& scene, Factors& factors) {
    if (const std::string tilted = tilt_warning(scene); !tilted.empty())
        factors.warnings.push_back(tilted);
    factors.unseen = static_cast<std::uint64_t>(
        std::count(factors.exits.begin(), factors.exits.end(), std::uint64_t(0)));
    double area = 0;
    for (const FactorNode& node : factors.nodes)
        area += node.area;
    factors.rest /= area;
    factors.leaks = is_closed(scene) ? factors.counts.odd : 0;
    if (factors.unseen > 0)
        factors.warnings.push_back(std::to_string(factors.unseen) +
                                   " rows were left by no line: they keep all to themselves; more "
                                   "bundles or a smaller --line-spacing would help");
    if (factors.rest > 0)
        factors.warnings.push_back("few lines left some rows: a share of " +
                                   std::to_string(factors.rest) +
                                   " of all area stays on the diagonal");
}

}  // namespace

Factors view_factors(const Scene& scene, const Patches& patches, const FactorSettings& settings,
                     const ProgressCallback& progress) {
    if (settings.bundles == 0)
        throw Error(Fault::usage, "factors need at least one bundle");
    const auto start = Clock::now();
    NodeMap map = make_nodes(scene, patches, settings.between);
    const SkyDome dome(settings.sky_parts, scene.sky.up, scene.sky.north);
    Factors factors;
    factors.sky_parts = dome.count();
    factors.threads = thread_count(settings.threads);
    factors.groups = choose_groups(settings);
    factors.line_spacing = choose_spacing(scene, patches, settings, factors.groups);
    check_copies(scene, line_sphere(scene).radius, factors.line_spacing);
    const bool by_points = sky_from_points(scene, patches, settings, factors.line_spacing);
    const FactorMemory memory(scene, patches, map.nodes.size(), factors, settings);
    memory.check_base();

    // Count the lines.
    PairCounts counts(map.nodes.size(), factors.outsides(), factors.threads);
    {
        PairSweep sweep(scene, patches, map, dome, factors.threads, counts);
        Counting(sweep, counts, memory, settings, progress, factors).run();
        factors.counts = sweep.line_counts();
    }
    factors.count_seconds = seconds_since(start);

    // Where there are few polygons, the sky is known better from points.
    const auto sky = Clock::now();
    std::optional<SkyShares> known;
    if (by_points && !factors.partial)
        known = sky_shares(scene, patches, map, settings.sky_tolerance, factors.threads);
    factors.sky_seconds = seconds_since(sky);

    // Make areas of them, exactly reciprocal and closed.
    const auto counted = Clock::now();
    factors.nodes = std::move(map.nodes);
    for (std::uint64_t exits : counts.exits())
        factors.exits.push_back((exits + PairCounts::line - 1) / PairCounts::line);
    SparseRows rows = take_rows(counts);
    set_errors(counts, rows, factors);
    set_exchange(counts, std::move(rows), known, settings, factors);
    add_warnings(scene, factors);
    factors.scale_seconds = seconds_since(counted);
    return factors;
}

}  // namespace parallux
