#include "output/interpolate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "output/local_fit.h"
#include "output/neighbours.h"
#include "parallel.h"

namespace parallux {

namespace {

// A corner of a piece, and its place as a lattice point: equal places have equal keys.
struct Corner {
    std::uint64_t key;
    std::uint64_t index;  // 4 piece + corner
    bool operator<(const Corner& other) const {
        return key != other.key ? key < other.key : index < other.index;
    }
};

// Turns places into 3 × 21 bits. The lattice is shifted by an odd share, so that round coordinates
// do not lie on its limits, where rounding would part them.
class PlaceKey {
public:
    explicit PlaceKey(const Scene& scene) {
        Bounds bounds = scene_bounds(scene);
        glm::dvec3 side = bounds.high - bounds.low;
        double longest = std::max({side.x, side.y, side.z, 1e-300});
        low_ = bounds.low;
        scale_ = 0x1p21 * 0.9991 / longest;
    }

    std::uint64_t operator()(const glm::dvec3& place) const {
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            double lattice = (place[axis] - low_[axis]) * scale_ + 0.3819;
            key = key << 21 | static_cast<std::uint64_t>(std::clamp(lattice, 0.0, 0x1p21 - 1));
        }
        return key;
    }

private:
    glm::dvec3 low_;
    double scale_;
};

std::vector<Corner> sorted_corners(const Scene& scene, const Patches& patches, const Pieces& pieces,
                                   unsigned threads) {
    PlaceKey key(scene);
    std::vector<Corner> corners(4 * std::size_t(pieces.count()));
    parallel_for(threads, pieces.count(), 1024, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t piece = begin; piece < end; ++piece) {
            std::uint32_t p = static_cast<std::uint32_t>(piece), s = pieces.surface(p);
            const Surface& surface = scene.surfaces[s];
            CellCorners cell = cell_corners(surface.shape(), patches.grids[s], pieces.cell(p));
            for (std::uint32_t k = 0; k < 4; ++k) {
                glm::dvec2 uv = cell.uv[std::min(k, cell.count - 1)];
                std::uint64_t at = k < cell.count ? key(surface_point(scene, surface, uv.x, uv.y))
                                                  : ~std::uint64_t(0);
                corners[4 * piece + k] = {at, 4 * piece + k};
            }
        }
    });
    std::erase_if(corners, [](const Corner& c) { return c.key == ~std::uint64_t(0); });
    std::sort(corners.begin(), corners.end());
    return corners;
}

// The patches that meet at one place, parted into sets that are joined there; each set has one
// value at the place, shared by the corners of all its pieces.
class Meeting {
public:
    Meeting(const std::vector<ExposedPatch>& exposed, const Neighbours& neighbours,
            const Pieces& pieces, const Solution& solution, const RayScene& rays)
        : exposed_(exposed),
          neighbours_(neighbours),
          rays_(rays),
          pieces_(pieces),
          solution_(solution),
          fit_(exposed, solution) {}

    void fit(const glm::dvec3& place, std::span<const Corner> corners, float* values) {
        part(corners);
        fit_sets(place);
        // Hand each corner its set's value; a hidden or torn one borrows one of a set on its side.
        for (const Corner& corner : corners) {
            std::uint32_t patch = patch_of(corner);
            auto place_in = std::lower_bound(patches_.begin(), patches_.end(), patch);
            std::uint32_t set = takes_part(patch)
                                    ? set_[static_cast<std::size_t>(place_in - patches_.begin())]
                                    : lender(patch);
            const float* from = set == none ? &solution_.irradiance[std::size_t(patch) * bands()]
                                            : &value_[std::size_t(set) * bands()];
            std::copy_n(from, bands(), values + corner.index * bands());
        }
    }

private:
    std::uint32_t bands() const { return solution_.bands; }
    std::uint32_t patch_of(const Corner& corner) const {
        return pieces_.patch(static_cast<std::uint32_t>(corner.index / 4));
    }

    // A patch that has a value of its own at the place.
    bool takes_part(std::uint32_t patch) const {
        return exposed_[patch].share > 0 && exposed_[patch].torn == all_torn_;
    }

    bool together(std::uint32_t a, std::uint32_t b) const {
        if (all_torn_)
            return glm::dot(exposed_[a].normal, exposed_[b].normal) > 0.999;
        return neighbours_.joined(a, b);
    }

    void part(std::span<const Corner> corners) {
        patches_.clear();
        all_torn_ = std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
            const ExposedPatch& patch = exposed_[patch_of(corner)];
            return patch.torn || !(patch.share > 0);
        });
        for (const Corner& corner : corners)
            if (std::uint32_t patch = patch_of(corner); takes_part(patch))
                patches_.push_back(patch);
        std::sort(patches_.begin(), patches_.end());
        patches_.erase(std::unique(patches_.begin(), patches_.end()), patches_.end());
        set_.resize(patches_.size());
        std::iota(set_.begin(), set_.end(), 0u);
        for (std::size_t a = 0; a < patches_.size(); ++a)
            for (std::size_t b = a + 1; b < patches_.size(); ++b)
                if (set_[a] != set_[b] && together(patches_[a], patches_[b])) {
                    std::uint32_t old = std::max(set_[a], set_[b]);
                    std::replace(set_.begin(), set_.end(), old, std::min(set_[a], set_[b]));
                }
    }

    void fit_sets(const glm::dvec3& place) {
        value_.assign(patches_.size() * bands(), 0);
        for (std::uint32_t set = 0; set < patches_.size(); ++set) {
            around_.clear();
            near_.clear();
            for (std::size_t i = 0; i < patches_.size(); ++i)
                if (set_[i] == set) {
                    around_.push_back(patches_[i]);
                    std::span<const std::uint32_t> list = neighbours_.of(patches_[i]);
                    near_.insert(near_.end(), list.begin(), list.end());
                }
            if (around_.empty())
                continue;
            near_.insert(near_.end(), around_.begin(), around_.end());
            std::sort(near_.begin(), near_.end());
            near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
            leave_torn(place);
            fit_.evaluate(place, around_, near_, &value_[std::size_t(set) * bands()]);
        }
    }

    // Leaves out torn patches; where only such meet, takes the whole ones that the place sees.
    void leave_torn(const glm::dvec3& place) {
        whole_.clear();
        const ExposedPatch& first = exposed_[around_.front()];
        glm::dvec3 lift = 0.02 * first.size * first.normal;
        for (std::uint32_t p : near_)
            if (!exposed_[p].torn &&
                (!all_torn_ ||
                 !rays_.blocked(place + lift, exposed_[p].seen + lift, exposed_[p].surface)))
                whole_.push_back(p);
        if (!whole_.empty())
            near_.swap(whole_);
    }

    std::uint32_t lender(std::uint32_t hidden) const {
        for (std::size_t i = 0; i < patches_.size(); ++i)
            if (glm::dot(exposed_[patches_[i]].normal, exposed_[hidden].normal) > 0.9)
                return set_[i];
        return none;
    }

    const std::vector<ExposedPatch>& exposed_;
    const Neighbours& neighbours_;
    const RayScene& rays_;
    const Pieces& pieces_;
    const Solution& solution_;
    LocalFit fit_;
    bool all_torn_ = false;  // no patch at the place is whole
    std::vector<std::uint32_t> patches_, set_, around_, near_, whole_;
    std::vector<float> value_;
};

}  // namespace

Interpolation::Interpolation(const Scene& scene, const Patches& patches, const Solution& solution,
                             const RayScene& rays, unsigned threads)
    : scene_(scene),
      patches_(patches),
      rays_(rays),
      pieces_(scene, patches),
      bands_(solution.bands) {
    std::vector<ExposedPatch> exposed = exposed_patches(scene, patches, pieces_, rays, threads);
    torn_.reserve(exposed.size());
    for (const ExposedPatch& patch : exposed)
        torn_.push_back(patch.torn);
    Neighbours neighbours(scene, exposed, rays, threads);
    std::vector<Corner> corners = sorted_corners(scene, patches, pieces_, threads);
    // Find where the corners of one place begin.
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (i == 0 || corners[i].key != corners[i - 1].key)
            begins.push_back(i);
    begins.push_back(corners.size());
    // Fit the values of each place.
    values_.assign(4 * std::size_t(pieces_.count()) * bands_, 0);
    parallel_for(threads, begins.size() - 1, 256, [&](std::size_t b, std::size_t e, unsigned) {
        Meeting meeting(exposed, neighbours, pieces_, solution, rays);
        for (std::size_t i = b; i < e; ++i) {
            std::span<const Corner> here(&corners[begins[i]],
                                         &corners[begins[i]] + begins[i + 1] - begins[i]);
            std::uint32_t piece = static_cast<std::uint32_t>(here.front().index / 4);
            std::uint32_t s = pieces_.surface(piece);
            const Surface& surface = scene.surfaces[s];
            glm::dvec2 uv = cell_corners(surface.shape(), patches.grids[s], pieces_.cell(piece))
                                .uv[here.front().index % 4];
            meeting.fit(surface_point(scene, surface, uv.x, uv.y), here, values_.data());
        }
    });
}

void Interpolation::drop_unseen(std::uint32_t surface, bool back, double u, double v,
                                const CellCorners& corners, std::array<double, 4>& weight) const {
    const Surface& on = scene_.surfaces[surface];
    glm::dvec2 middle(0);
    for (std::uint32_t k = 0; k < corners.count; ++k)
        middle += corners.uv[k] / double(corners.count);
    auto point = [&](const glm::dvec2& uv) { return surface_point(scene_, on, uv.x, uv.y); };
    double size = glm::distance(point(corners.uv[0]), point(corners.uv[1]));
    glm::dvec3 lift = (back ? -0.02 : 0.02) * size * surface_normal(scene_, on);
    // Ask a little within the corners, where walls that end on them are not in the way.
    std::array<double, 4> seen{};
    double sum = 0;
    for (std::uint32_t k = 0; k < corners.count; ++k) {
        glm::dvec3 corner = point(corners.uv[k] + 0.002 * (middle - corners.uv[k]));
        if (!rays_.blocked(point({u, v}) + lift, corner + lift, surface))
            sum += seen[k] = weight[k] + 1e-6;
    }
    if (sum > 0)
        for (std::uint32_t k = 0; k < 4; ++k)
            weight[k] = seen[k] / sum;
}

void Interpolation::at(std::uint32_t surface, bool back, double u, double v,
                       float* irradiance) const {
    const SurfaceGrid& grid = patches_.grids[surface];
    std::uint32_t cell = cell_at(scene_.surfaces[surface].shape(), grid.nu, grid.nv,
                                 static_cast<float>(u), static_cast<float>(v));
    in_cell(surface, back, cell, u, v, irradiance);
}

void Interpolation::in_cell(std::uint32_t surface, bool back, std::uint32_t cell, double u,
                            double v, float* irradiance) const {
    const SurfaceGrid& grid = patches_.grids[surface];
    Shape shape = scene_.surfaces[surface].shape();
    std::array<double, 4> weight = corner_weights(shape, grid, cell, u, v);
    std::uint32_t piece = pieces_.index(surface, back, cell);
    if (torn_[pieces_.patch(piece)])
        drop_unseen(surface, back, u, v, cell_corners(shape, grid, cell), weight);
    const float* value = &values_[4 * std::size_t(piece) * bands_];
    for (std::uint32_t band = 0; band < bands_; ++band) {
        double sum = 0;
        for (int k = 0; k < 4; ++k)
            sum += weight[k] * value[k * bands_ + band];
        irradiance[band] = static_cast<float>(sum);
    }
}

Spectrum Interpolation::coming_through(std::uint32_t surface, bool back, double u, double v) const {
    const SurfaceGrid& grid = patches_.grids[surface];
    return coming_through(surface, back,
                          cell_at(scene_.surfaces[surface].shape(), grid.nu, grid.nv,
                                  static_cast<float>(u), static_cast<float>(v)),
                          u, v);
}

Spectrum Interpolation::coming_through(std::uint32_t surface, bool back, std::uint32_t cell,
                                       double u, double v) const {
    Spectrum through = scene_.materials[scene_.surfaces[surface].material].transmittance_of(!back);
    if (patches_.grids[surface].back == none || through == Spectrum{})
        return {};
    Spectrum arriving;
    in_cell(surface, !back, cell, u, v, arriving.value.data());
    for (std::uint32_t band = 0; band < bands_; ++band)
        through[band] *= arriving[band];
    return through;
}

}  // namespace parallux
