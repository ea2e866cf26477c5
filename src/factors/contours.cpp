#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "factors/dilogarithm.h"
#include "factors/gauss_legendre.h"
#include "factors/ways.h"
#include "parallux/spectrum.h"

// A_a F_ab = 1/2π Σ over pairs of edges (d·e) ∬ ln r ds dt. A share k · length · length with one k
// for all pairs cancels in the sum over closed contours: every integral below is ∬ (ln r + 3/2),
// the form without such a term.

namespace parallux {

namespace {

// Edges whose angle's sine is below this are parallel …
constexpr double parallel_sine = 1e-12;
// … and below this so nearly that their lines come closest too far away for the closed form.
constexpr double nearly_parallel_sine = 1e-2;
// Lines closer than this (the polygons' extent is 1) meet.
constexpr double meeting = 1e-9;

struct Edge {
    glm::dvec3 from, direction;
    double length;

    glm::dvec3 at(double s) const { return from + s * direction; }
};

// ∫ (ln r + 1) dτ along a line, from the foot of the perpendicular of length w to τ.
double log_along(double tau, double w, double r) {
    return (r > 0 ? tau * std::log(r) : 0) + (w > 0 ? w * std::atan(tau / w) : 0);
}

// ∬ (ln r + 3/2) of two parallel edges: by the second antiderivative in x = s - t.
double parallel_pair(const Edge& a, const Edge& b) {
    double t0 = glm::dot(b.from - a.from, a.direction);
    double t1 = glm::dot(b.at(b.length) - a.from, a.direction);
    if (t0 > t1)
        std::swap(t0, t1);
    double h = glm::length(glm::cross(b.at(b.length / 2) - a.from, a.direction));
    auto second = [h](double x) {
        double r2 = x * x + h * h;
        return (r2 > 0 ? (x * x - h * h) * std::log(r2) / 4 : 0) +
               (h > 0 ? h * x * std::atan(x / h) : 0);
    };
    return second(a.length - t0) - second(a.length - t1) - second(-t0) + second(-t1);
}

// ∬ (ln r + 3/2) of two edges on lines that come closest, to h, where s = t = 0. As
// div((s, t) ln r) = 2 ln r + 1 - h²/r²,
//   2 ∬ (ln r + 3/2) = Σ ± (s ∫ (ln r + 1) dt + t ∫ (ln r + 1) ds) + h² ∬ ds dt / r²
// over the corners of the domain. With s sinα = h sinh u and t sinα = h sinh v the last term is
//   h²/sinα Σ ± (Im Li₂(-e^(-u-v-iα)) - Im Li₂(e^(u-v+iα))),
// from 1/r² integrated over t, an arc tangent, which is the argument of a product:
// sinh v - sinh z = ½ e^v (1 - e^(z-v)) (1 + e^(-z-v)), z = u + iα.
double skew_pair(const Edge& a, const Edge& b, double cosine, double sine) {
    glm::dvec3 way = b.from - a.from, across = glm::cross(a.direction, b.direction);
    double along_a = glm::dot(way, a.direction), along_b = glm::dot(way, b.direction);
    double s0 = -(along_a - cosine * along_b) / (sine * sine);
    double t0 = -(cosine * along_a - along_b) / (sine * sine);
    double h = std::fabs(glm::dot(way, across)) / sine;
    double angle = std::atan2(sine, cosine), sum = 0;
    for (int end_a : {0, 1})
        for (int end_b : {0, 1}) {
            double s = s0 + end_a * a.length, t = t0 + end_b * b.length;
            glm::dvec3 r = b.at(end_b * b.length) - a.at(end_a * a.length);
            double length = glm::length(r);
            double w_a = glm::length(glm::cross(r, a.direction));
            double w_b = glm::length(glm::cross(r, b.direction));
            double term = s * log_along(glm::dot(r, b.direction), w_b, length) +
                          t * log_along(-glm::dot(r, a.direction), w_a, length);
            if (h > meeting) {
                double u = std::asinh(s * sine / h), v = std::asinh(t * sine / h);
                term += h * h / sine *
                        (dilogarithm_sine(-u - v, pi - angle) - dilogarithm_sine(u - v, angle));
            }
            sum += end_a == end_b ? term : -term;
        }
    return sum / 2;
}

// ∬ (ln r + 3/2) of two nearly parallel edges: in closed form along b, by Gauss-Legendre rules
// along a, on pieces cut in half until each is small against its distance from where the integrand
// is not smooth: across from b's ends and where the two lines come closest.
class NearlyParallelPair {
public:
    NearlyParallelPair(const Edge& a, const Edge& b, double cosine, double sine) : a_(a), b_(b) {
        glm::dvec3 way = b.from - a.from;
        double s = glm::dot(way, a.direction) - cosine * glm::dot(way, b.direction);
        double h = std::fabs(glm::dot(way, glm::cross(a.direction, b.direction)));
        rough_[0] = {s / (sine * sine), h / (sine * sine)};
        for (int end : {0, 1}) {
            glm::dvec3 r = b.at(end * b.length) - a.from;
            rough_[1 + end] = {glm::dot(r, a.direction), glm::length(glm::cross(r, a.direction))};
        }
    }

    double integral() const {
        return piece(a_.length / 2, a_.length / 2, 0) + a_.length * b_.length / 2;
    }

private:
    // ∫ (ln r + 1) dt.
    double inner(double s) const {
        glm::dvec3 first = b_.from - a_.at(s), last = b_.at(b_.length) - a_.at(s);
        double w = glm::length(glm::cross(first, b_.direction));
        return log_along(glm::dot(last, b_.direction), w, glm::length(last)) -
               log_along(glm::dot(first, b_.direction), w, glm::length(first));
    }

    double piece(double middle, double half, int depth) const {
        constexpr int deepest = 20;  // what the integrand's kinks leave falls with the square
        for (const Rough& rough : rough_)
            if (depth < deepest && std::hypot(rough.place - middle, rough.distance) < 3 * half)
                return piece(middle - half / 2, half / 2, depth + 1) +
                       piece(middle + half / 2, half / 2, depth + 1);
        double sum = 0;
        for (const GaussNode& node : rule_)
            sum += node.weight * inner(middle + half * node.place);
        return half * sum;
    }

    // A singularity of the integrand at place ± i distance.
    struct Rough {
        double place, distance;
    };

    const Edge& a_;
    const Edge& b_;
    std::array<Rough, 3> rough_;
    GaussRule rule_{GaussRule::most};
};

double edge_pair(const Edge& a, const Edge& b) {
    double cosine = glm::dot(a.direction, b.direction);
    if (std::fabs(cosine) < 1e-15)
        return 0;
    double sine = glm::length(glm::cross(a.direction, b.direction));
    if (sine < parallel_sine)
        return cosine * parallel_pair(a, b);
    if (sine < nearly_parallel_sine)
        return cosine * NearlyParallelPair(a, b, cosine, sine).integral();
    return cosine * skew_pair(a, b, cosine, sine);
}

// A polygon's edges, moved and scaled; those without length left out.
struct Contour {
    std::array<Edge, Polygon::max_corners + 1> edges;
    std::size_t size = 0;

    Contour(const Polygon& polygon, const glm::dvec3& origin, double scale) {
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            glm::dvec3 way = (polygon.next(k) - polygon[k]) / scale;
            double length = glm::length(way);
            if (length > 0)
                edges[size++] = {(polygon[k] - origin) / scale, way / length, length};
        }
    }
};

}  // namespace

double contour_exchange(const Polygon& a, const Polygon& b) {
    double scale = std::max(radius(a, a[0]), radius(b, a[0]));
    Contour first(a, a[0], scale), second(b, a[0], scale);
    double sum = 0;
    for (std::size_t k = 0; k < first.size; ++k)
        for (std::size_t l = 0; l < second.size; ++l)
            sum += edge_pair(first.edges[k], second.edges[l]);
    return sum * scale * scale / (2 * pi);
}

}  // namespace parallux
