#include "solve/shot_exact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "parallel.h"
#include "random.h"
#include "solve/shot_rays.h"
#include "solve/sobol.h"
#include "solve/visibility.h"

namespace parallux {

namespace {

constexpr std::size_t cells_a_chunk = 64;

// Draws of one pair of source and cell in one shot.
Random draws(std::uint64_t seed, std::size_t source, std::size_t pair) {
    return Random(seed, stream::first_shot + 16 + (std::uint64_t(source) << 32) + pair);
}

}  // namespace

struct ExactShot::Chunk {
    std::vector<Seen> seen;
    std::vector<Pair> pairs;
    std::vector<std::uint32_t> blockers;
};

ExactShot::ExactShot(const Scene& scene, const Patches& patches, const RayScene& rays, Cells cells,
                     const Emitters& emitters, unsigned threads, const std::function<bool()>& go_on)
    : scene_(scene),
      patches_(patches),
      rays_(rays),
      cells_(std::move(cells)),
      threads_(threads),
      sources_(sources_of(scene, patches, emitters)) {
    if (scene.surfaces.size() <= few_surfaces)
        for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
            surfaces_.push_back(whole_polygon(scene, s, false));
    bool going_on = true;
    while (going_on && views_.size() < sources_.size()) {
        views_.push_back(view_of(views_.size()));
        going_on = go_on();
    }
}

ExactShot::View ExactShot::view_of(std::size_t source) {
    View view;
    view.by_rays = covered_in_part(sources_[source].piece, sources_[source].polygon);
    if (view.by_rays)
        return view;
    std::vector<Chunk> chunks((cells().size() - 1) / cells_a_chunk + 1);
    parallel_for(threads_, chunks.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        DenormalsOff guard;
        for (std::size_t k = begin; k < end; ++k)
            look(source, k * cells_a_chunk, std::min((k + 1) * cells_a_chunk, cells().size()),
                 chunks[k]);
    });
    // Count first: arrays that grow take twice the memory.
    std::size_t cells_seen = 0, pairs = 0;
    for (const Chunk& chunk : chunks)
        cells_seen += chunk.seen.size(), pairs += chunk.pairs.size();
    view.seen.reserve(cells_seen);
    view.pairs.reserve(pairs);
    for (Chunk& chunk : chunks) {
        view.seen.insert(view.seen.end(), chunk.seen.begin(), chunk.seen.end());
        for (Pair& pair : chunk.pairs) {
            if (!pair.by_rays())
                pair.first += static_cast<std::uint32_t>(blockers_.size());
            view.pairs.push_back(pair);
        }
        blockers_.insert(blockers_.end(), chunk.blockers.begin(), chunk.blockers.end());
    }
    for (const Seen& seen : view.seen)
        view.sum += seen.factor;
    view.closed = sees_only_patches(sources_[source]);
    // What is left of rounding and of the rules of few points, where nothing may be left.
    if (view.sum > 1 || (view.closed && view.pairs.empty())) {
        for (Seen& seen : view.seen)
            seen.factor /= view.sum;
        view.sum = 1;
    }
    return view;
}

// Sorts out which of some cells see a source, and past what.
void ExactShot::look(std::size_t source, std::size_t begin, std::size_t end, Chunk& chunk) const {
    const Source& from = sources_[source];
    const double own_area = area(from.polygon);
    std::vector<std::uint32_t> candidates;
    const Emitter* surface = nullptr;
    PointViews views(scene_, rays_, surfaces_);
    for (std::size_t k = begin; k < end; ++k) {
        const Emitter& cell = cells()[k];
        const Polygon polygon = polygon_of(scene_, cell);
        const double factor = exchange_nearly(polygon, from.polygon) / own_area;
        if (!(factor > 0))
            continue;
        const auto first = static_cast<std::uint32_t>(chunk.blockers.size());
        if (!surfaces_.empty()) {
            // What may hide the cell's surface, and of that what may hide the cell.
            if (!surface || surface->surface != cell.surface || surface->back != cell.back)
                candidates = views.between(whole_polygon(scene_, cell.surface, cell.back),
                                           from.polygon, cell.surface, from.piece.surface);
            surface = &cell;
            const Shaft shaft(polygon, from.polygon);
            for (std::uint32_t candidate : candidates)
                if (shaft.holds(surfaces_[candidate]))
                    chunk.blockers.push_back(candidate);
            const auto count = static_cast<std::uint32_t>(chunk.blockers.size()) - first;
            if (count == 0 && !covered_in_part(cell, polygon))
                chunk.seen.push_back({static_cast<std::uint32_t>(k), factor});
            else
                chunk.pairs.push_back(
                    {static_cast<std::uint32_t>(k),
                     views.grid_for(cell, from.polygon, {chunk.blockers.data() + first, count}),
                     first, count, factor});
            continue;
        }
        chunk.pairs.push_back(
            {static_cast<std::uint32_t>(k), rays_for(scene_, rays_, from, cell), none, 0, factor});
    }
}

bool ExactShot::covered_in_part(const Emitter& side, const Polygon& part) const {
    return rays_.covered_in_part(side.surface, emitter_normal(scene_, side),
                                 {part.begin(), part.end()});
}

// Of the first so many.
double ExactShot::power_share(std::size_t sources) const {
    double sent = 0, all = 0;
    for (std::size_t source = 0; source < sources_.size(); ++source)
        for (double power : sources_[source].power) {
            sent += source < sources ? power : 0;
            all += power;
        }
    return sources < sources_.size() && all > 0 ? sent / all : 1;
}

double ExactShot::shoot(const Run& run, std::vector<std::int64_t>& emitted,
                        std::vector<std::int64_t>& escaped, std::uint64_t& done,
                        const std::function<bool(double)>& go_on) const {
    const std::uint32_t bands = patches_.bands;
    bool going_on = true;
    while (going_on && done < views_.size()) {
        const std::size_t source = done;
        const Source& from = sources_[source];
        const View& view = views_[source];
        const std::vector<double> found =
            factors_of(source, run.settings.seed, run.plan.shot_effort);
        double scale = 1, sum = 0;
        for (double factor : found)
            sum += factor;
        if (view.closed || view.sum + sum > 1)
            scale = sum > 0 ? std::max(0.0, (1 - view.sum) / sum) : 1;

        // Rounded as running sums, so that no quantum is lost or made.
        std::vector<std::int64_t> before(bands, 0);
        double up_to = 0;
        auto receive = [&](std::uint32_t patch, double factor) {
            up_to += factor;
            if (up_to > 1 - 1e-12)
                up_to = 1;
            for (std::uint32_t band = 0; band < bands; ++band) {
                const std::int64_t quanta = std::llrint(up_to * from.power[band]);
                run.banks.receive(0, patch * std::size_t(bands) + band, quanta - before[band]);
                before[band] = quanta;
            }
        };
        for (const Seen& seen : view.seen)
            receive(cells()[seen.cell].patch, seen.factor);
        for (std::size_t k = 0; k < found.size(); ++k)
            receive(cells()[view.pairs[k].cell].patch, scale * found[k]);
        if (view.by_rays) {
            const std::vector<std::uint32_t> met =
                met_by_rays(source, run.settings.seed, run.plan.shot_effort);
            for (std::uint32_t patch : met)
                if (patch != none)
                    receive(patch, 1 / static_cast<double>(met.size()));
        }
        for (std::uint32_t band = 0; band < bands; ++band) {
            const std::int64_t power = std::llrint(from.power[band]);
            emitted[band] += power;
            escaped[band] += power - before[band];
        }
        going_on = go_on(static_cast<double>(++done) / static_cast<double>(views_.size()));
    }
    return power_share(done);
}

// The patches that rays of equal power from a source meet; none: nothing.
std::vector<std::uint32_t> ExactShot::met_by_rays(std::size_t source, std::uint64_t seed,
                                                  double effort) const {
    constexpr double rays = 1 << 14;
    const Emitter& from = sources_[source].piece;
    const glm::dvec3 normal = emitter_normal(scene_, from);
    std::vector<std::uint32_t> met(static_cast<std::size_t>(std::max(1.0, rays * effort * effort)));
    const Sobol sobol(mix64(seed ^ stream::first_shot) + source);
    parallel_for(threads_, met.size(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        DenormalsOff guard;
        for (std::size_t k = begin; k < end; ++k) {
            const auto p = sobol.point(static_cast<std::uint32_t>(k));
            met[k] = patch_of(
                scene_, patches_,
                rays_.closest(point_on(scene_, from, p[0], p[1]),
                              cosine_direction(normal, p[2], p[3]), INFINITY, from.surface));
        }
    });
    return met;
}

// Of the pairs that may be hidden, as this shot finds them.
std::vector<double> ExactShot::factors_of(std::size_t source, std::uint64_t seed,
                                          double effort) const {
    const Source& from = sources_[source];
    const View& view = views_[source];
    const double own_area = area(from.polygon);
    std::vector<double> factors(view.pairs.size());
    parallel_for(threads_, factors.size(), 64, [&](std::size_t begin, std::size_t end, unsigned) {
        DenormalsOff guard;
        PointViews views(scene_, rays_, surfaces_);
        for (std::size_t k = begin; k < end; ++k) {
            const Pair& pair = view.pairs[k];
            const Emitter& cell = cells()[pair.cell];
            // Where light changes little across the cell, a few points more are enough.
            const double finer = pair.by_rays()      ? std::max(1.0, effort * effort)
                                 : pair.samples == 1 ? std::sqrt(effort)
                                                     : effort;
            const double samples = finer * pair.samples;
            const auto count = static_cast<std::uint32_t>(std::max(1.0, std::round(samples)));
            Random random = draws(seed, source, k);
            if (pair.by_rays())
                factors[k] = pair.factor * visible_share(scene_, rays_, from, cell, count, random);
            else
                factors[k] =
                    area(polygon_of(scene_, cell)) / own_area *
                    views.mean(cell, from.polygon, {blockers_.data() + pair.first, pair.blockers},
                               count, random);
        }
    });
    return factors;
}

bool ExactShot::sees_only_patches(const Source& source) const {
    constexpr int tries = 1024;
    Random random(0, stream::first_shot + 1);
    DenormalsOff guard;
    for (int k = 0; k < tries; ++k) {
        double p[4];
        for (double& x : p)
            x = random.uniform();
        const SurfaceHit hit =
            rays_.closest(point_on(scene_, source.piece, p[0], p[1]),
                          cosine_direction(emitter_normal(scene_, source.piece), p[2], p[3]),
                          INFINITY, source.piece.surface);
        if (patch_of(scene_, patches_, hit) == none)
            return false;
    }
    return true;
}

}  // namespace parallux
