#include "factors/open_sky.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace parallux {

namespace {

// Sines below this are rounding.
constexpr double flat = 1e-9;

// Grows with the azimuth, by 1 a quarter: [0, 4).
double diamond(double x, double y) {
    const double sum = std::fabs(x) + std::fabs(y);
    if (sum == 0)
        return 0;
    const double t = y / sum;
    return x >= 0 ? (y >= 0 ? t : 4 + t) : 2 - t;
}

constexpr std::uint64_t everywhere = ~std::uint64_t(0);

// The 64 sectors that azimuths first + low … first + high lie in.
std::uint64_t sectors_of(double first, double low, double high) {
    if (high - low >= 2 - 1e-9)
        return everywhere;
    const int begin = static_cast<int>(std::floor(16 * (first + low) - 1e-6));
    const int end = static_cast<int>(std::floor(16 * (first + high) + 1e-6));
    std::uint64_t sectors = 0;
    for (int k = begin; k <= end; ++k)
        sectors |= std::uint64_t(1) << (k & 63);
    return sectors;
}

double turned(double from, double to) {
    const double by = to - from;
    return by > 2 ? by - 4 : by < -2 ? by + 4 : by;
}

}  // namespace

void SkyBlockers::View::keep(std::uint32_t face) {
    Face kept = all_.faces_[face];
    for (std::uint32_t k = 0; k < kept.size; ++k) {
        std::uint32_t& corner = corner_[kept.corner[k]];
        if (corner == none) {
            corner = static_cast<std::uint32_t>(corners_.size());
            corners_.push_back(kept.corner[k]);
        }
        std::uint32_t& edge = edge_[kept.edge[k]];
        if (edge == none) {
            edge = static_cast<std::uint32_t>(edges_.size());
            edges_.push_back(kept.edge[k]);
        }
        kept.corner[k] = corner;
        kept.edge[k] = edge;
    }
    faces_.push_back(kept);
}

// What subtends most comes first: outlines are soon hidden.
void SkyBlockers::View::order(const glm::dvec3& point) {
    std::vector<std::pair<double, std::uint32_t>> size;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        const Face& face = faces_[f];
        const glm::dvec3 r = all_.corners_[corners_[face.corner[0]]] - point;
        const glm::dvec3 a = all_.corners_[corners_[face.corner[1]]] - point - r;
        const glm::dvec3 b = all_.corners_[corners_[face.corner[2]]] - point - r;
        const glm::dvec3 middle = r + (a + b) / 3.0;
        const double away = glm::dot(middle, middle);
        size.emplace_back(
            -std::fabs(glm::dot(glm::cross(a, b), middle)) / (away * std::sqrt(away) + 1e-300), f);
    }
    std::sort(size.begin(), size.end());
    std::vector<Face> ordered;
    for (const auto& [negative, f] : size)
        ordered.push_back(faces_[f]);
    faces_ = std::move(ordered);
}

void SkyBlockers::View::turn(std::span<const glm::dvec3> patch, const glm::dvec3& normal) {
    normal_ = normal;
    const glm::dvec3& up = all_.up_;
    const glm::dvec3 across = std::fabs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    east_ = glm::normalize(glm::cross(across, up));
    north_ = glm::cross(up, east_);
    double ground = 1e300, plane = 1e300, size = 0;
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : patch) {
        ground = std::min(ground, glm::dot(corner, up));
        plane = std::min(plane, glm::dot(corner, normal));
        size = std::max(size, glm::length(corner - patch[0]));
        middle += corner / static_cast<double>(patch.size());
    }
    over_.resize(all_.corners_.size());
    for (std::size_t k = 0; k < over_.size(); ++k) {
        const glm::dvec3& c = all_.corners_[k];
        over_[k] = static_cast<std::uint8_t>((glm::dot(c, up) - ground > flat * size ? 1 : 0) |
                                             (glm::dot(c, normal) - plane > flat * size ? 2 : 0));
    }
    corner_.assign(all_.corners_.size(), none);
    edge_.assign(all_.edges_.size(), none);
    corners_.clear();
    edges_.clear();
    faces_.clear();
    for (std::uint32_t f = 0; f < all_.faces_.size(); ++f) {
        unsigned over = 0;
        for (std::uint32_t k = 0; k < all_.faces_[f].size; ++k)
            over |= over_[all_.faces_[f].corner[k]];
        if (over == 3)
            keep(f);
    }
    order(middle);
}

SkyBlockers::View::Ray SkyBlockers::View::ray_to(const glm::dvec3& place,
                                                 const glm::dvec3& point) const {
    const glm::dvec3 d = glm::normalize(place - point);
    return {d, glm::dot(d, normal_), glm::dot(d, all_.up_),
            diamond(glm::dot(d, east_), glm::dot(d, north_))};
}

// Cones of the faces, and which side of its edges each lies on.
void SkyBlockers::View::look(const glm::dvec3& point) {
    rays_.clear();
    for (std::uint32_t corner : corners_)
        rays_.push_back(ray_to(all_.corners_[corner], point));
    planes_.clear();
    for (std::uint32_t edge : edges_) {
        const auto& [a, b] = all_.edges_[edge].corner;
        const glm::dvec3 across =
            glm::cross(rays_[corner_[a]].direction, rays_[corner_[b]].direction);
        const double sine = glm::length(across);
        planes_.push_back({across / std::max(sine, 1e-300), sine, 0, none});
    }
    reaches_.clear();
    cones_.clear();
    for (const Face& face : faces_)
        look_at(face);
}

void SkyBlockers::View::look_at(const Face& face) {
    Cone cone;
    cone.size = face.size;
    cone.edge = face.edge;
    cone.face = static_cast<std::uint32_t>(&face - faces_.data());
    const Ray& first = rays_[face.corner[0]];
    double low = 0, high = 0, top = 0, thick = 0, nearest = 1;
    bool over = false;
    for (std::uint32_t k = 0; k < face.size; ++k) {
        const Ray &ray = rays_[face.corner[k]], &next = rays_[face.corner[(k + 1) % face.size]];
        const double by = turned(first.azimuth, ray.azimuth);
        low = std::min(low, by);
        high = std::max(high, by);
        over |= ray.over_normal > flat;
        top = std::max(top, ray.over_up);
        thick = std::max(thick, planes_[face.edge[k]].sine);
        nearest = std::min(nearest, glm::dot(ray.direction, next.direction));
    }
    if (!over || top <= flat)
        return;
    if (face.size == 4)
        nearest =
            std::min({nearest, glm::dot(first.direction, rays_[face.corner[2]].direction),
                      glm::dot(rays_[face.corner[1]].direction, rays_[face.corner[3]].direction)});
    const double volume = glm::dot(glm::cross(first.direction, rays_[face.corner[1]].direction),
                                   rays_[face.corner[2]].direction);
    if (std::fabs(volume) <= flat * thick * thick)
        return;  // edge on
    for (std::uint32_t k = 0; k < face.size; ++k) {
        const std::uint32_t a = corners_[face.corner[k]];
        const std::uint32_t b = corners_[face.corner[(k + 1) % face.size]];
        Plane& plane = planes_[face.edge[k]];
        const bool along = (a < b) == (volume > 0);
        cone.inward[k] = along ? plane.normal : -plane.normal;
        plane.faces_on |= along ? 1 : 2;
        plane.face = std::min(plane.face, cone.face);
    }
    // No sum of unit vectors with weights of sum 1 is shorter than the root of their least cosine.
    top = nearest > 0.01 ? std::min(1.0, top / std::sqrt(nearest)) : 1;
    reaches_.push_back({sectors_of(first.azimuth, low, high), top});
    cones_.push_back(cone);
}

// The part of an edge that may bound the sky.
bool SkyBlockers::View::outline(std::size_t edge, Arc& arc) const {
    const Plane& plane = planes_[edge];
    if (plane.faces_on != 1 && plane.faces_on != 2)
        return false;
    const auto& [first_corner, second_corner] = all_.edges_[edges_[edge]].corner;
    const Ray &a = rays_[corner_[first_corner]], &b = rays_[corner_[second_corner]];
    arc.inward = plane.faces_on == 1 ? plane.normal : -plane.normal;
    if (plane.sine <= 1e-15 || std::fabs(glm::dot(arc.inward, normal_)) < 1e-13)
        return false;
    double begin = 0, end = 1;
    for (const auto& [first, second] :
         {std::pair{a.over_normal, b.over_normal}, std::pair{a.over_up, b.over_up}}) {
        if (first <= flat && second <= flat)
            return false;
        if (first < 0)
            begin = std::max(begin, first / (first - second));
        if (second < 0)
            end = std::min(end, first / (first - second));
    }
    if (begin >= end)
        return false;
    arc.from = a.direction + begin * (b.direction - a.direction);
    arc.to = a.direction + end * (b.direction - a.direction);
    const double by = turned(a.azimuth, b.azimuth);
    arc.reach = {sectors_of(a.azimuth, std::min(by, 0.0), std::max(by, 0.0)),
                 std::max(0.0, std::min(a.over_up, b.over_up))};
    arc.edge = static_cast<std::uint32_t>(edge);
    arc.face = plane.face;
    return true;
}

// Which part of an arc a face hides, if any.
bool SkyBlockers::View::hides(const Cone& cone, const Arc& arc, double& begin, double& end) const {
    for (std::uint32_t k = 0; k < cone.size; ++k) {
        if (cone.edge[k] == arc.edge)
            return false;
        const double a = glm::dot(cone.inward[k], arc.from);
        const double b = glm::dot(cone.inward[k], arc.to);
        if (std::fabs(a) <= flat && std::fabs(b) <= flat) {
            // On one line: between two faces it is hidden; of two on the same side one counts;
            // those on either side take each other away.
            if (planes_[cone.edge[k]].faces_on != 3 &&
                (glm::dot(cone.inward[k], arc.inward) < 0 || cone.face > arc.face))
                return false;
        } else if (a <= 0 && b <= 0) {
            return false;
        } else if (a < 0) {
            begin = std::max(begin, a / (a - b));
        } else if (b < 0) {
            end = std::min(end, a / (a - b));
        }
    }
    return begin < end;
}

// The angle of what no face hides of an arc.
double SkyBlockers::View::open_part(const Arc& arc) {
    open_.assign(1, {0, 1});
    for (std::size_t k = 0; k < cones_.size(); ++k) {
        if ((reaches_[k].sectors & arc.reach.sectors) == 0 || reaches_[k].top < arc.reach.top)
            continue;
        double begin = open_.front().first, end = open_.back().second;
        if (!hides(cones_[k], arc, begin, end))
            continue;
        left_.clear();
        for (const auto& [first, second] : open_) {
            if (begin > first)
                left_.emplace_back(first, std::min(begin, second));
            if (end < second)
                left_.emplace_back(std::max(end, first), second);
        }
        open_.swap(left_);
        if (open_.empty())
            return 0;
    }
    double angle = 0;
    for (const auto& [first, second] : open_) {
        const glm::dvec3 a = arc.from + first * (arc.to - arc.from);
        const glm::dvec3 b = arc.from + second * (arc.to - arc.from);
        angle += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    }
    return angle;
}

// What is open of the bounds of all directions above the point's plane and the horizon.
double SkyBlockers::View::open_horizon() {
    const glm::dvec3& up = all_.up_;
    const double cosine = glm::dot(normal_, up);
    auto half = [&](const glm::dvec3& pole, const glm::dvec3& end, const glm::dvec3& middle,
                    std::uint64_t sectors) {
        // A little inside, so that what stands on the bound hides it.
        const glm::dvec3 in = 2 * flat * (normal_ + up);
        double angle = 0;
        for (double sign : {1.0, -1.0})
            angle += open_part({sign * end + in, middle + in, pole, {sectors, 0}, none, none});
        return angle;
    };
    glm::dvec3 end = glm::cross(normal_, up);
    const double sine = glm::length(end);
    if (sine < 1e-9) {
        if (cosine < 0)
            return 0;
        return half(up, east_, north_, everywhere) + half(up, east_, -north_, everywhere);
    }
    end /= sine;
    const glm::dvec3 high = glm::normalize(up - cosine * normal_);
    const glm::dvec3 level = glm::normalize(normal_ - cosine * up);
    return half(normal_, end, high, everywhere) + cosine * half(up, end, level, everywhere);
}

double SkyBlockers::View::sky(const glm::dvec3& point) {
    look(point);
    double sum = open_horizon();
    for (std::size_t edge = 0; edge < edges_.size(); ++edge)
        if (Arc arc; outline(edge, arc))
            sum -= open_part(arc) * glm::dot(arc.inward, normal_);
    return sum / (2 * pi);
}

}  // namespace parallux
