#include "lines/shared_places.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "lines/depth_order.h"
#include "lines/sheets.h"
#include "surfaces/curve.h"

namespace parallux {

namespace {

// In radii.
constexpr double same_plane = coordinate_rounding;
// Of normals: what two surfaces of one plane differ by, when their corners are rounded so.
constexpr double same_normal = 1e-4;
constexpr double normal_cell = 1.0 / 64, offset_cell = 1.0 / 1024;

// One surface in a cell of (normal, distance of its plane from the scene's middle).
struct Member {
    std::int64_t cell;
    std::uint32_t surface;
};

struct Box {
    glm::dvec3 low{1e300}, high{-1e300};
};

struct Flat {
    std::array<glm::dvec3, 4> corner;
    unsigned corners;
    glm::dvec3 normal;  // turned so that its largest component is positive
    double offset;
    Box box;
};

// A corner; of disks, of the square about them.
glm::dvec3 corner_of(const Scene& scene, const Surface& surface, unsigned k) {
    return surface.is_curved() ? disk_square(scene.curves[surface.curve])[k]
                               : scene.positions[surface.corner[k]];
}

Flat flat_of(const Scene& scene, const Surface& surface, const glm::dvec3& centre) {
    Flat flat;
    flat.corners = surface.shape() == Shape::triangle ? 3 : 4;
    glm::dvec3 middle(0);
    for (unsigned k = 0; k < flat.corners; ++k) {
        flat.corner[k] = corner_of(scene, surface, k) - centre;
        middle += flat.corner[k] / double(flat.corners);
        flat.box.low = glm::min(flat.box.low, flat.corner[k]);
        flat.box.high = glm::max(flat.box.high, flat.corner[k]);
    }
    flat.normal = surface_normal(scene, surface);
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(flat.normal[axis]) > std::abs(flat.normal[largest]) + 2 * same_normal)
            largest = axis;
    if (flat.normal[largest] < 0)
        flat.normal = -flat.normal;
    flat.offset = glm::dot(middle, flat.normal);
    return flat;
}

// Whether two convex polygons of one plane have an area in common, wider than `slack` across every
// edge (the theorem of separating axes).
bool overlap(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b, const glm::dvec3& normal,
             double slack) {
    auto parted_by_edge_of = [&](std::span<const glm::dvec3> of) {
        for (std::size_t k = 0; k < of.size(); ++k) {
            const glm::dvec3 edge = of[k + 1 == of.size() ? 0 : k + 1] - of[k];
            const double length = glm::length(edge);
            if (length == 0)
                continue;
            const glm::dvec3 across = glm::cross(normal, edge) / length;
            double a_low = 1e300, a_high = -1e300, b_low = 1e300, b_high = -1e300;
            for (const glm::dvec3& corner : a) {
                a_low = std::min(a_low, glm::dot(across, corner));
                a_high = std::max(a_high, glm::dot(across, corner));
            }
            for (const glm::dvec3& corner : b) {
                b_low = std::min(b_low, glm::dot(across, corner));
                b_high = std::max(b_high, glm::dot(across, corner));
            }
            if (std::min(a_high, b_high) - std::max(a_low, b_low) <= slack)
                return true;
        }
        return false;
    };
    return !parted_by_edge_of(a) && !parted_by_edge_of(b);
}

bool share(const Flat& a, const Flat& b, double radius) {
    if (std::abs(glm::dot(a.normal, b.normal)) < 1 - same_normal)
        return false;
    const double slack = same_plane * radius;
    for (int axis = 0; axis < 3; ++axis)
        if (a.box.low[axis] > b.box.high[axis] + slack ||
            b.box.low[axis] > a.box.high[axis] + slack)
            return false;
    for (unsigned k = 0; k < b.corners; ++k)
        if (std::abs(glm::dot(b.corner[k], a.normal) - a.offset) > slack)
            return false;
    return overlap({a.corner.data(), a.corners}, {b.corner.data(), b.corners}, a.normal, 4 * slack);
}

// Puts a surface in every cell that those of its plane may be in.
void add_members(const Flat& flat, std::uint32_t surface, double radius,
                 std::vector<Member>& members) {
    std::array<std::array<std::int64_t, 2>, 4> range;
    auto cells = [](double value, double slack, double cell) {
        return std::array<std::int64_t, 2>{
            static_cast<std::int64_t>(std::floor((value - slack) / cell)),
            static_cast<std::int64_t>(std::floor((value + slack) / cell))};
    };
    // Normals that differ by 1e-4 in the cosine differ by up to 0.015 in a component; those of one
    // plane by far less.
    for (int axis = 0; axis < 3; ++axis)
        range[axis] = cells(flat.normal[axis], same_normal, normal_cell);
    range[3] = cells(flat.offset / radius, 2 * same_plane, offset_cell);
    for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x)
        for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y)
            for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z)
                for (std::int64_t d = range[3][0]; d <= range[3][1]; ++d)
                    members.push_back(
                        {(((x + 256) * 1024 + y + 256) * 1024 + z + 256) * 65536 + d + 32768,
                         surface});
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;

// All pairs of one cell that share a place, by a sweep along the axis in which they reach farthest.
void add_pairs(const Scene& scene, const glm::dvec3& centre, double radius,
               std::span<const Member> members, std::vector<Pair>& pairs) {
    if (members.size() < 2)
        return;
    std::vector<std::pair<Flat, std::uint32_t>> flats;
    Box all;
    for (const Member& member : members) {
        flats.emplace_back(flat_of(scene, scene.surfaces[member.surface], centre), member.surface);
        all.low = glm::min(all.low, flats.back().first.box.low);
        all.high = glm::max(all.high, flats.back().first.box.high);
    }
    const glm::dvec3 size = all.high - all.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::sort(flats.begin(), flats.end(), [&](const auto& a, const auto& b) {
        const double low_a = a.first.box.low[axis], low_b = b.first.box.low[axis];
        return low_a != low_b ? low_a < low_b : a.second < b.second;
    });
    for (auto a = flats.begin(); a != flats.end(); ++a)
        for (auto b = a + 1; b != flats.end() && b->first.box.low[axis] <= a->first.box.high[axis];
             ++b)
            if (share(a->first, b->first, radius)) {
                pairs.emplace_back(a->second, b->second);
                pairs.emplace_back(b->second, a->second);
            }
}

}  // namespace

SharedPlaces::SharedPlaces(const Scene& scene) {
    const Bounds bounds = scene_bounds(scene);
    const glm::dvec3 centre = 0.5 * (bounds.low + bounds.high);
    radius_ = std::max(0.5 * glm::length(bounds.high - bounds.low), 1e-300);
    std::vector<Member> members;
    members.reserve(scene.surfaces.size() + scene.surfaces.size() / 8);
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s)
        if (!scene.surfaces[s].is_curved() || is_disk(scene.curves[scene.surfaces[s].curve]))
            add_members(flat_of(scene, scene.surfaces[s], centre), s, radius_, members);
    std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.surface < b.surface;
    });
    std::vector<Pair> pairs;
    for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
        for (end = begin; end < members.size() && members[end].cell == members[begin].cell;)
            ++end;
        add_pairs(scene, centre, radius_, {members.data() + begin, end - begin}, pairs);
    }
    if (pairs.empty())
        return;
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    begin_.assign(scene.surfaces.size() + 1, 0);
    plane_of_.assign(scene.surfaces.size(), none);
    for (const Pair& pair : pairs) {
        ++begin_[pair.first + 1];
        others_.push_back(pair.second);
        const bool sheet =
            are_sheet(scene, scene.surfaces[pair.first], scene.surfaces[pair.second]);
        if (plane_of_[pair.first] != none) {
            planes_.back().sheet |= sheet;
            continue;
        }
        plane_of_[pair.first] = static_cast<std::uint32_t>(planes_.size());
        const Surface& surface = scene.surfaces[pair.first];
        Plane plane;
        plane.origin = corner_of(scene, surface, 0);
        plane.u = corner_of(scene, surface, 1) - plane.origin;
        plane.v = corner_of(scene, surface, surface.corner[3] == none ? 2 : 3) - plane.origin;
        if (surface.is_curved())
            plane.disk = scene.curves[surface.curve];
        plane.normal = surface_normal(scene, surface);
        plane.uu = glm::dot(plane.u, plane.u);
        plane.uv = glm::dot(plane.u, plane.v);
        plane.vv = glm::dot(plane.v, plane.v);
        plane.surface = surface;
        plane.sheet = sheet;
        planes_.push_back(plane);
    }
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        begin_[s + 1] += begin_[s];
}

bool SharedPlaces::from_behind(std::uint32_t surface, const glm::dvec3& direction) const {
    return glm::dot(plane(surface).normal, direction) > 0;
}

bool SharedPlaces::before(std::uint32_t a, std::uint32_t b, const glm::dvec3& direction) const {
    const bool behind = from_behind(a, direction);
    const int rank_a = place_rank(behind, plane(a).sheet);
    const int rank_b = place_rank(from_behind(b, direction), plane(b).sheet);
    if (rank_a != rank_b)
        return rank_a < rank_b;
    // Both normals point the same way: the gap along it, from a to b.
    const double gap = glm::dot(plane(b).origin - plane(a).origin, plane(a).normal);
    if (std::abs(gap) > 1e-9 * radius_)
        return (gap > 0) == behind;
    return (a < b) != behind;
}

bool SharedPlaces::in_plane(std::uint32_t surface, const glm::dvec3& point) const {
    const Plane& p = plane(surface);
    return std::abs(glm::dot(point - p.origin, p.normal)) <= same_plane * radius_;
}

bool SharedPlaces::covers_part(std::uint32_t surface, const glm::dvec3& out,
                               std::span<const glm::dvec3> part) const {
    for (std::uint32_t other : with(surface)) {
        const Plane& p = plane(other);
        const bool triangle = p.surface.shape() == Shape::triangle;
        const std::array<glm::dvec3, 4> corner{p.origin, p.origin + p.u,
                                               triangle ? p.origin + p.v : p.origin + p.u + p.v,
                                               p.origin + p.v};
        if (before(surface, other, out) &&
            overlap(part, {corner.data(), triangle ? 3u : 4u}, p.normal, 4 * same_plane * radius_))
            return true;
    }
    return false;
}

bool SharedPlaces::holds(std::uint32_t surface, const glm::dvec3& point, double& u,
                         double& v) const {
    const Plane& p = plane(surface);
    if (p.disk)
        return on_disk(*p.disk, point, u, v);
    const glm::dvec3 way = point - p.origin;
    const double along_u = glm::dot(way, p.u), along_v = glm::dot(way, p.v);
    const double area = p.uu * p.vv - p.uv * p.uv;
    u = (along_u * p.vv - along_v * p.uv) / area;
    v = (along_v * p.uu - along_u * p.uv) / area;
    return u >= 0 && v >= 0 &&
           (p.surface.shape() == Shape::triangle ? u + v <= 1 : u <= 1 && v <= 1);
}

}  // namespace parallux
