#include "solve/shot_exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "factors/form_factors.h"
#include "parallel.h"
#include "random.h"
#include "solve/shot_rays.h"

namespace parallux {

namespace {

// One polygon that emits evenly: a cell, or the whole of a surface.
struct Source {
    Polygon polygon;
    Emitter piece;
    std::vector<double> power;  // quanta, one a band
};

// Cells of one surface and side that all emit the same become one.
std::vector<Source> sources_of(const Run& run, const Emitters& emitters) {
    std::vector<Source> sources;
    std::uint32_t bands = emitters.bands;
    auto power_of = [&](std::size_t piece) { return &emitters.power[piece * bands]; };
    for (std::size_t first = 0; first < emitters.pieces.size();) {
        const Emitter& piece = emitters.pieces[first];
        std::size_t end = first;
        bool alike = true;
        while (end < emitters.pieces.size() && emitters.pieces[end].surface == piece.surface &&
               emitters.pieces[end].back == piece.back) {
            alike = alike && std::equal(power_of(end), power_of(end) + bands, power_of(first));
            ++end;
        }
        const SurfaceGrid& grid = run.patches.grids[piece.surface];
        if (alike && end - first == std::size_t(grid.nu) * grid.nv) {
            Emitter whole = piece;
            whole.cell = {0, 0, 0, 0.5, 0.5, 0, 0, 1, 1};
            Source source{polygon_of(run.scene, whole), whole, {}};
            for (std::uint32_t band = 0; band < bands; ++band)
                source.power.push_back(static_cast<double>(end - first) * power_of(first)[band]);
            sources.push_back(source);
        } else {
            for (std::size_t k = first; k < end; ++k)
                sources.push_back({polygon_of(run.scene, emitters.pieces[k]),
                                   emitters.pieces[k],
                                   {power_of(k), power_of(k) + bands}});
        }
        first = end;
    }
    return sources;
}

// Which share of what one polygon sends the other arrives: pairs of stratified points, weighted by
// the kernel cos θ cos θ' / r². 1 when no ray of the first 64 pairs is blocked, 0 when all are.
double visible_share(const Run& run, const Source& source, const Emitter& receiver) {
    constexpr std::uint32_t few = 64, many = 1024;
    glm::dvec3 n = emitter_normal(run.scene, source.piece);
    glm::dvec3 m = emitter_normal(run.scene, receiver);
    double seen = 0, all = 0;
    std::uint32_t blocked = 0;
    // Points of the four-dimensional R sequence (M. Roberts, The unreasonable effectiveness of
    // quasirandom sequences, 2018): even on both polygons, and on their pairs.
    auto fraction = [](double x) { return x - std::floor(x); };
    for (std::uint32_t k = 0; k < many; ++k) {
        constexpr double step[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378086,
                                    0.5385972572236100};
        double p[4];
        for (int axis = 0; axis < 4; ++axis)
            p[axis] = fraction(0.5 + step[axis] * (k + 1));
        glm::dvec3 a = point_on(run.scene, source.piece, p[0], p[1]);
        glm::dvec3 b = point_on(run.scene, receiver, p[2], p[3]);
        glm::dvec3 way = b - a;
        double square = glm::dot(way, way);
        double kernel = glm::dot(way, n) * -glm::dot(way, m) / (square * square);
        if (!(kernel > 0))
            continue;
        all += kernel;
        if (run.rays->blocked(a, b, source.piece.surface, receiver.surface))
            ++blocked;
        else
            seen += kernel;
        if (k + 1 == few && blocked == 0)
            return 1;
        if (k + 1 == few && seen == 0)
            return 0;
    }
    return all > 0 ? seen / all : 0;
}

// Whether all that a source emits lands on patches, as far as 4096 rays can tell.
bool sees_only_patches(const Run& run, const Source& source) {
    Random random(run.settings.seed, stream::first_shot + 1);
    for (int k = 0; k < 4096; ++k) {
        double p[4];
        for (double& x : p)
            x = random.uniform();
        SurfaceHit hit =
            run.rays->closest(point_on(run.scene, source.piece, p[0], p[1]),
                              cosine_direction(emitter_normal(run.scene, source.piece), p[2], p[3]),
                              std::numeric_limits<double>::infinity(), source.piece.surface);
        if (patch_of(run.scene, run.patches, hit) == none)
            return false;
    }
    return true;
}

// Form factors to all receivers. In a scene that lets nothing out they add up to 1: what sampling
// has found of the half-hidden ones is scaled until they do.
std::vector<double> factors_of(const Run& run, const Source& source,
                               const std::vector<Emitter>& receivers) {
    std::vector<double> factors(receivers.size(), 0);
    std::vector<char> sampled(receivers.size(), 0);
    double own_area = area(source.polygon);
    parallel_for(run.plan.threads, receivers.size(), 64,
                 [&](std::size_t begin, std::size_t end, unsigned) {
                     DenormalsOff guard;
                     for (std::size_t k = begin; k < end; ++k) {
                         Polygon polygon = polygon_of(run.scene, receivers[k]);
                         double factor = exchange_area(source.polygon, polygon) / own_area;
                         if (!(factor > 0))
                             continue;
                         double share = visible_share(run, source, receivers[k]);
                         factors[k] = factor * share;
                         sampled[k] = share < 1;
                     }
                 });
    double whole = 0, half_hidden = 0;
    for (std::size_t k = 0; k < factors.size(); ++k)
        (sampled[k] ? half_hidden : whole) += factors[k];
    bool closed = sees_only_patches(run, source);
    if (closed || whole + half_hidden > 1) {
        double scale = half_hidden > 0 ? std::max(0.0, (1 - whole) / half_hidden) : 1;
        for (std::size_t k = 0; k < factors.size(); ++k)
            factors[k] *= sampled[k] ? scale : 1;
        double sum = whole + scale * half_hidden;
        for (double& factor : factors)
            factor /= sum;
    }
    return factors;
}

}  // namespace

void shoot_exact(const Run& run, const Emitters& emitters, std::vector<std::int64_t>& emitted,
                 std::vector<std::int64_t>& escaped) {
    const std::uint32_t bands = emitters.bands;
    const std::vector<Emitter> receivers = all_cells(run.scene, run.patches);
    std::vector<Source> sources = sources_of(run, emitters);
    for (const Source& source : sources) {
        std::vector<double> factors = factors_of(run, source, receivers);
        // Rounded as running sums, so that no quantum is lost or made.
        std::vector<std::int64_t> before(bands, 0);
        double sum = 0;
        for (std::size_t k = 0; k < receivers.size(); ++k) {
            sum += factors[k];
            if (sum > 1 - 1e-12)
                sum = 1;
            for (std::uint32_t band = 0; band < bands; ++band) {
                std::int64_t up_to = std::llrint(sum * source.power[band]);
                run.banks.receive(0, receivers[k].patch * std::size_t(bands) + band,
                                  up_to - before[band]);
                before[band] = up_to;
            }
        }
        for (std::uint32_t band = 0; band < bands; ++band) {
            std::int64_t power = std::llrint(source.power[band]);
            emitted[band] += power;
            escaped[band] += power - before[band];
        }
    }
}

}  // namespace parallux
