#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "parallux/factors.h"
#include "solve/plan_lines.h"
#include "view_factors/errors.h"
#include "view_factors/memory.h"
#include "view_factors/nodes.h"
#include "view_factors/pair_sweep.h"
#include "view_factors/scale.h"

namespace parallux {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// As fine as the patches ask, and so that a bundle is worth its projection.
double choose_spacing(const Scene& scene, const Patches& patches, const FactorSettings& settings) {
    constexpr double usual_lines_a_patch = 4, least_lines_a_bundle = 16384;
    if (settings.line_spacing > 0)
        return settings.line_spacing;
    if (settings.lines_per_patch > 0)
        return std::sqrt(mean_area(patches) / settings.lines_per_patch);
    const double radius = line_sphere(scene).radius;
    return std::sqrt(std::min(mean_area(patches) / usual_lines_a_patch,
                              pi * radius * radius / least_lines_a_bundle));
}

std::uint32_t choose_groups(const FactorSettings& settings) {
    const std::uint32_t wanted = settings.groups ? settings.groups : settings.bundles >= 64 ? 8 : 1;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(wanted, settings.bundles));
}

// Follows the bundles, group by group.
class Counting {
public:
    Counting(PairSweep& sweep, PairCounts& counts, const FactorMemory& memory,
             const FactorSettings& settings, const ProgressCallback& progress, Factors& result)
        : sweep_(sweep),
          counts_(counts),
          memory_(memory),
          settings_(settings),
          progress_(progress),
          result_(result),
          // Groups are as long as one another, so that their spread tells the error.
          a_group_((settings.bundles - 1) / result.groups + 1) {}

    void run() {
        const std::uint32_t groups = std::exchange(result_.groups, 0);
        all_ = a_group_ * groups;
        for (std::uint32_t group = 0; group < groups && !result_.partial; ++group) {
            follow_group(group);
            counts_.end_group(result_.threads);
            ++result_.groups;
        }
    }

private:
    void follow_group(std::uint32_t group) {
        const BundleSettings lattice{
            group == 0 ? settings_.seed : mix64(settings_.seed ^ mix64(group)), a_group_,
            settings_.directions, result_.line_spacing};
        for (std::uint64_t done = 0; done < a_group_ && !result_.partial;) {
            const auto count = static_cast<std::uint32_t>(
                std::min<std::uint64_t>(sweep_.at_once(), a_group_ - done));
            sweep_.bundles(lattice, done, count);
            done += count;
            result_.bundles += count;
            look_at_memory();
            report();
        }
    }

    // What a sixteenth of the first group has met tells what all will; twice as many tell it
    // better.
    void look_at_memory() {
        memory_.check_tables(counts_);
        if (result_.bundles > a_group_ || 16 * result_.bundles < look_ * a_group_)
            return;
        result_.predicted_memory = memory_.check_pairs(
            counts_.pairs(), static_cast<double>(result_.bundles), static_cast<double>(all_));
        look_ *= 2;
    }

    void report() {
        if (!progress_)
            return;
        Progress progress;
        progress.stage = "bundles";
        progress.done = static_cast<double>(result_.bundles) / static_cast<double>(all_);
        progress.lines = sweep_.line_counts().lines;
        progress.seconds = seconds_since(start_);
        result_.partial = !progress_(progress) && result_.bundles < all_;
    }

    PairSweep& sweep_;
    PairCounts& counts_;
    const FactorMemory& memory_;
    const FactorSettings& settings_;
    const ProgressCallback& progress_;
    Factors& result_;
    std::uint64_t a_group_, all_ = 0, look_ = 1;
    Clock::time_point start_ = Clock::now();
};

std::vector<double> areas_of(const std::vector<FactorNode>& nodes) {
    std::vector<double> area(nodes.size());
    for (std::size_t i = 0; i < area.size(); ++i)
        area[i] = nodes[i].area;
    return area;
}

// Leaves entries out that are below the threshold both ways and not the largest of a row.
SparseRows without_small(const SparseRows& counts, const Account& account,
                         const std::vector<double>& area, double threshold) {
    const SparseRows& exchange = account.exchange;
    std::vector<double> largest(area.size(), 0);
    for (std::size_t i = 0; i < area.size(); ++i)
        for (std::uint64_t k = exchange.start[i]; k < exchange.start[i + 1]; ++k)
            largest[i] = std::max(largest[i], exchange.value[k]);
    return kept(counts, [&](std::size_t i, std::uint64_t k) {
        const double x = exchange.value[k];
        const std::uint32_t j = counts.column[k];
        return x >= threshold * std::min(area[i], area[j]) || x >= largest[i] || x >= largest[j];
    });
}

// Exchange areas from counts: closed, and closed again without what is below the threshold.
void scale(const PairCounts& counts, SparseRows rows, const FactorSettings& settings,
           Factors& factors) {
    const std::size_t n = factors.nodes.size();
    const std::vector<double> area = areas_of(factors.nodes);
    // n_i = D A_i / (2 δ²): a line stands for so much of an exchange area.
    const double cell =
        2 * factors.line_spacing * factors.line_spacing / static_cast<double>(factors.bundles);
    for (double& value : rows.value)
        value *= cell;
    std::vector<double> outside(n, 0);
    for (std::size_t k = 0; k < counts.outside().size(); ++k)
        outside[k / counts.outsides()] += cell * static_cast<double>(counts.outside()[k]);
    Account account;
    if (settings.threshold > 0) {
        account = close_account(rows, outside, area, {}, factors.threads);
        SparseRows large = account.rest > 0
                               ? kept(rows, [&](std::size_t, std::uint64_t) { return true; })
                               : without_small(rows, account, area, settings.threshold);
        factors.dropped = rows.column.size() - large.column.size();
        account = close_account(std::move(large), outside, area, account.scale, factors.threads);
    } else {
        account = close_account(std::move(rows), outside, area, {}, factors.threads);
    }
    factors.outside.resize(counts.outside().size());
    for (std::size_t k = 0; k < factors.outside.size(); ++k) {
        const std::size_t i = k / counts.outsides();
        factors.outside[k] =
            account.scale[i] * (cell * static_cast<double>(counts.outside()[k])) / area[i];
    }
    factors.rest = account.rest;
    factors.start = std::move(account.exchange.start);
    factors.column = std::move(account.exchange.column);
    factors.exchange = std::move(account.exchange.value);
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
    factors.line_spacing = choose_spacing(scene, patches, settings);
    check_copies(scene, line_sphere(scene).radius, factors.line_spacing);
    factors.groups = choose_groups(settings);
    const FactorMemory memory(scene, patches, map.nodes.size(), factors.outsides(), factors.threads,
                              settings.max_memory);
    memory.check_base();

    // Count the lines.
    PairCounts counts(map.nodes.size(), factors.outsides(), factors.threads);
    {
        PairSweep sweep(scene, patches, map, dome, factors.threads, counts);
        Counting(sweep, counts, memory, settings, progress, factors).run();
        factors.counts = sweep.line_counts();
    }
    factors.count_seconds = seconds_since(start);

    // Make areas of them, exactly reciprocal and closed.
    const auto counted = Clock::now();
    factors.nodes = std::move(map.nodes);
    factors.exits = counts.exits();
    SparseRows rows = take_rows(counts, factors.threads);
    set_errors(counts, rows, factors);
    scale(counts, std::move(rows), settings, factors);
    add_warnings(scene, factors);
    factors.scale_seconds = seconds_since(counted);
    return factors;
}

}  // namespace parallux
