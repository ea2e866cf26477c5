#include "output/exposed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "lines/sheets.h"
#include "parallel.h"

namespace parallux {

namespace {

constexpr int few_points = 16;      // tells whether anything is hidden
constexpr int many_points = 256;    // measures how much
constexpr double contact = 0.02;    // patch sides: nearer is upon it
constexpr double close_lamp = 0.5;  // patch sides: a lamp nearer than that lights what it covers

// A point of a patch on one of its surfaces.
struct PatchPoint {
    glm::dvec3 position;
    std::uint32_t surface;
};

// One piece as a corner and two edges.
struct Frame {
    glm::dvec3 origin, a, b;
    double area;
    std::uint32_t surface;
    bool triangle;
};

class Finder {
public:
    Finder(const Scene& scene, const Patches& patches, const Pieces& pieces, const RayScene& rays)
        : scene_(scene), patches_(patches), pieces_(pieces), rays_(rays) {
        Bounds bounds = scene_bounds(scene);
        rounding_ = 2e-6 * glm::length(bounds.high - bounds.low);
    }

    ExposedPatch find(std::uint32_t patch, std::vector<Frame>& frames) const {
        const std::span<const std::uint32_t> all = pieces_.of_patch(patch);
        if (!all.empty() && scene_.surfaces[pieces_.surface(all.front())].is_curved())
            return curved_cell(patch, all.front());
        ExposedPatch result = whole(patch, frames);
        if (!(result.area > 0)) {
            result.share = 0;
            return result;
        }
        // Ask a few points; measure with many where they disagree.
        std::vector<glm::dvec3> exposed;
        int points = few_points;
        ask(result, frames, points, exposed);
        if (!exposed.empty() && exposed.size() < few_points) {
            points = many_points;
            ask(result, frames, points, exposed);
        }
        result.share = double(exposed.size()) / points;
        // A lamp's share is not known well enough to see the little that is left beside it.
        if (result.cover != Spectrum() && result.share < 0.5)
            result.share = 0;
        if (result.share > 0 && result.share < 1) {
            result.mean = glm::dvec3(0);
            for (const glm::dvec3& p : exposed)
                result.mean += p;
            result.mean /= double(exposed.size());
            result.area *= result.share;
        }
        result.seen = nearest(exposed, result);
        result.torn = result.share > 0 && !result.cluster && torn(result, frames[0], exposed);
        return result;
    }

private:
    // Centroid, normal and size of the whole patch; its pieces in `frames`.
    ExposedPatch whole(std::uint32_t patch, std::vector<Frame>& frames) const {
        frames.clear();
        ExposedPatch result;
        glm::dvec3 normal(0);
        for (std::uint32_t piece : pieces_.of_patch(patch)) {
            std::uint32_t s = pieces_.surface(piece);
            const Surface& surface = scene_.surfaces[s];
            CellCorners c = cell_corners(surface.shape(), patches_.grids[s], pieces_.cell(piece));
            auto at = [&](std::uint32_t k) {
                return surface_point(scene_, surface, c.uv[k].x, c.uv[k].y);
            };
            Frame f{at(0), at(1) - at(0), at(c.count - 1) - at(0), 0, s, c.count == 3};
            f.area = glm::length(glm::cross(f.a, f.b)) * (f.triangle ? 0.5 : 1.0);
            double middle = f.triangle ? 1.0 / 3 : 0.5;
            result.mean += f.area * (f.origin + middle * (f.a + f.b));
            result.area += f.area;
            double side = pieces_.back(piece) ? -f.area : f.area;
            normal += side * surface_normal(scene_, surface);
            frames.push_back(f);
        }
        if (!(result.area > 0) || !(glm::length(normal) > 0))
            return {};
        result.mean /= result.area;
        result.normal = glm::normalize(normal);
        result.surface = frames.front().surface;
        result.cluster = frames.size() > 1;
        for (const Frame& f : frames)
            for (const glm::dvec3& p : {f.origin, f.origin + f.a, f.origin + f.b,
                                        f.triangle ? f.origin : f.origin + f.a + f.b})
                result.extent = std::max(result.extent, glm::distance(p, result.mean));
        set_size(result);
        return result;
    }

    // A curved cell is taken to be exposed, in its middle: the plane of its corners is not it, and
    // at a pole it has but three.
    ExposedPatch curved_cell(std::uint32_t patch, std::uint32_t piece) const {
        ExposedPatch result;
        result.surface = pieces_.surface(piece);
        result.area = patches_.area[patch];
        const Surface& surface = scene_.surfaces[result.surface];
        const SurfaceGrid& grid = patches_.grids[result.surface];
        const CellCorners c = cell_corners(surface.shape(), grid, pieces_.cell(piece));
        const double u = (pieces_.cell(piece) % grid.nu + 0.5) / grid.nu;
        const double v = (pieces_.cell(piece) / grid.nu + 0.5) / grid.nv;
        result.mean = result.seen = surface_point(scene_, surface, u, v);
        result.normal = surface_normal(scene_, surface, u, v) * (pieces_.back(piece) ? -1.0 : 1.0);
        for (std::uint32_t k = 0; k < c.count; ++k)
            result.extent = std::max(
                result.extent,
                glm::distance(surface_point(scene_, surface, c.uv[k].x, c.uv[k].y), result.mean));
        set_size(result);
        return result;
    }

    static void set_size(ExposedPatch& patch) {
        const double side = std::sqrt(patch.area);
        patch.size = std::clamp(std::sqrt(2.0) * patch.extent, side, 3 * side);
    }

    void ask(ExposedPatch& patch, const std::vector<Frame>& frames, int points,
             std::vector<glm::dvec3>& exposed) const {
        exposed.clear();
        Spectrum cover;
        for (int i = 0; i < points; ++i) {
            PatchPoint p = point(patch, frames, i, points);
            if (!hidden(p, patch, cover))
                exposed.push_back(p.position);
        }
        for (std::uint32_t b = 0; b < patches_.bands; ++b)
            patch.cover[b] = cover[b] / static_cast<float>(points);
    }

    // Point i of n, spread evenly by area: a Fibonacci lattice over the row of pieces.
    static PatchPoint point(const ExposedPatch& patch, const std::vector<Frame>& frames, int i,
                            int n) {
        double along = (i + 0.5) / n * patch.area;
        std::size_t k = 0;
        while (k + 1 < frames.size() && along > frames[k].area)
            along -= frames[k++].area;
        const Frame& f = frames[k];
        double a = f.area > 0 ? std::min(along / f.area, 1.0) : 0.5;
        double b = std::fmod((i + 0.5) * 0.6180339887498949, 1.0);
        if (f.triangle && a + b > 1)
            a = 1 - a, b = 1 - b;
        return {f.origin + a * f.a + b * f.b, f.surface};
    }

    bool hidden(const PatchPoint& p, const ExposedPatch& patch, Spectrum& cover) const {
        // Something that faces it lies upon it, and is not the other face of the same sheet.
        double height = std::max(rounding_, contact * patch.size);
        SurfaceHit hit =
            rays_.closest(p.position - rounding_ * patch.normal, patch.normal,
                          rounding_ + std::max(height, close_lamp * patch.size), p.surface);
        if (hit.surface != none && !inert_back(hit) &&
            !are_sheet(scene_, scene_.surfaces[hit.surface], scene_.surfaces[p.surface])) {
            const float* emission = &patches_.emission[std::size_t(patch_at(hit)) * patches_.bands];
            bool lamp =
                std::any_of(emission, emission + patches_.bands, [](float e) { return e > 0; });
            for (std::uint32_t b = 0; b < patches_.bands; ++b)
                cover[b] += emission[b];
            if (lamp || hit.t <= rounding_ + height)
                return true;
        }
        // It looks at nothing but inert backs: along the normal, and five ways around it.
        if (!looks_at_back(p, patch.normal))
            return false;
        glm::dvec3 t = std::abs(patch.normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        t = glm::normalize(glm::cross(patch.normal, t));
        glm::dvec3 b = glm::cross(patch.normal, t);
        for (int i = 0; i < 5; ++i) {
            double phi = 2 * pi * i / 5;
            if (!looks_at_back(p, 0.4 * patch.normal + std::cos(phi) * t + std::sin(phi) * b))
                return false;
        }
        return true;
    }

    bool looks_at_back(const PatchPoint& p, const glm::dvec3& direction) const {
        SurfaceHit hit = rays_.closest(p.position, direction, HUGE_VAL, p.surface);
        return hit.surface != none && inert_back(hit);
    }

    std::uint32_t patch_at(const SurfaceHit& hit) const {
        const SurfaceGrid& grid = patches_.grids[hit.surface];
        return (hit.back ? grid.back : grid.front) +
               cell_at(scene_.surfaces[hit.surface].shape(), grid.nu, grid.nv, hit.u, hit.v);
    }

    bool inert_back(const SurfaceHit& hit) const {
        return hit.back && patches_.grids[hit.surface].back == none;
    }

    // Whether something stands between its parts: across the lines through its middle, or where
    // part of it is hidden between the points that are not.
    bool torn(const ExposedPatch& patch, const Frame& f,
              const std::vector<glm::dvec3>& exposed) const {
        glm::dvec3 lift = (2 * rounding_ + 0.02 * patch.size) * patch.normal;
        auto parted = [&](const glm::dvec3& a, const glm::dvec3& b) {
            return rays_.blocked(a + lift, b + lift, patch.surface);
        };
        if (patch.share < 1)
            return std::any_of(exposed.begin(), exposed.end(),
                               [&](const glm::dvec3& p) { return parted(patch.seen, p); });
        // A little within the corners, so that walls along the cell's own edges do not count.
        std::array<glm::dvec3, 4> corner = {f.origin, f.origin + f.a, f.origin + f.a + f.b,
                                            f.origin + f.b};
        if (f.triangle)
            corner[2] = corner[3];
        for (int k = 0; k < (f.triangle ? 3 : 4); ++k)
            if (parted(patch.mean, patch.mean + 0.998 * (corner[k] - patch.mean)))
                return true;
        return false;
    }

    static glm::dvec3 nearest(const std::vector<glm::dvec3>& exposed, const ExposedPatch& patch) {
        if (patch.share == 1 && !patch.cluster)
            return patch.mean;
        glm::dvec3 best = patch.mean;
        double distance = HUGE_VAL;
        for (const glm::dvec3& p : exposed)
            if (double d = glm::distance(p, patch.mean); d < distance)
                best = p, distance = d;
        return best;
    }

    const Scene& scene_;
    const Patches& patches_;
    const Pieces& pieces_;
    const RayScene& rays_;
    double rounding_;
};

}  // namespace

std::vector<ExposedPatch> exposed_patches(const Scene& scene, const Patches& patches,
                                          const Pieces& pieces, const RayScene& rays,
                                          unsigned threads) {
    Finder finder(scene, patches, pieces, rays);
    std::vector<ExposedPatch> result(patches.count());
    parallel_for(threads, result.size(), 256, [&](std::size_t begin, std::size_t end, unsigned) {
        std::vector<Frame> frames;
        for (std::size_t p = begin; p < end; ++p)
            result[p] = finder.find(static_cast<std::uint32_t>(p), frames);
    });
    return result;
}

}  // namespace parallux
