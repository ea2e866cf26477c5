#include <cmath>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "parallux/lines.h"
#include "random.h"

namespace parallux {

namespace {

// A uniform random rotation from three uniform numbers (K. Shoemake, Uniform random rotations,
// Graphics Gems III, 1992), as the columns of a matrix.
struct Rotation {
    glm::dvec3 x, y, z;

    explicit Rotation(Random& random) {
        double u1 = random.uniform(), a2 = 2 * pi * random.uniform(),
               a3 = 2 * pi * random.uniform();
        double r1 = std::sqrt(1 - u1), r2 = std::sqrt(u1);
        double qx = r1 * std::sin(a2), qy = r1 * std::cos(a2);
        double qz = r2 * std::sin(a3), qw = r2 * std::cos(a3);
        x = {1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw), 2 * (qx * qz - qy * qw)};
        y = {2 * (qx * qy - qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz + qx * qw)};
        z = {2 * (qx * qz + qy * qw), 2 * (qy * qz - qx * qw), 1 - 2 * (qx * qx + qy * qy)};
    }

    glm::dvec3 operator*(const glm::dvec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

// A point of the lattice and how many there are.
struct LatticePoint {
    std::uint64_t point, count;
};

LatticePoint lattice_point(const BundleSettings& settings, std::uint64_t index) {
    if (!settings.twice)
        return {shuffled(index, settings.count, settings.seed), settings.count};
    const std::uint64_t first = settings.count / 2, second = settings.count - first;
    const std::uint64_t firsts = (first + 1) / 2, count = firsts + (second + 1) / 2;
    const std::uint64_t place =
        index < first ? shuffled(index, first, mix64(settings.seed + 1)) / 2
                      : firsts + shuffled(index - first, second, mix64(settings.seed + 2)) / 2;
    return {shuffled(place, count, settings.seed), count};
}

}  // namespace

glm::dvec2 uniform_disk(Random& random, double& square) {
    for (;;) {
        glm::dvec2 p(2 * random.uniform() - 1, 2 * random.uniform() - 1);
        square = p.x * p.x + p.y * p.y;
        if (square < 1)
            return p;
    }
}

glm::dvec3 uniform_direction(Random& random) {
    // G. Marsaglia, Choosing a point from the surface of a sphere, 1972: no trigonometry, so that
    // square roots alone, which are the same everywhere, decide the bits.
    double square = 0;
    glm::dvec2 p = uniform_disk(random, square);
    double scale = 2 * std::sqrt(1 - square);
    return {scale * p.x, scale * p.y, 1 - 2 * square};
}

glm::dvec3 fibonacci_direction(std::uint64_t point, std::uint64_t count) {
    // Equal steps in z; in angle the golden ratio's share of a turn, kept in 64-bit fractions of
    // a turn so that it stays exact for any count.
    double z = 1 - (2 * static_cast<double>(point) + 1) / static_cast<double>(count);
    double turn = static_cast<double>(point * 0x9e3779b97f4a7c15ull) * 0x1p-64;
    double r = std::sqrt(std::fmax(0.0, 1 - z * z));
    return {r * std::cos(2 * pi * turn), r * std::sin(2 * pi * turn), z};
}

std::uint64_t shuffled(std::uint64_t index, std::uint64_t count, std::uint64_t seed) {
    if (count < 2)
        return index;
    // A Feistel network is a permutation of 2^(2h) numbers; steps that leave [0, count) are
    // walked on until they come back, which keeps it a permutation of [0, count).
    unsigned half = 1;
    while ((std::uint64_t(1) << (2 * half)) < count)
        ++half;
    std::uint64_t mask = (std::uint64_t(1) << half) - 1;
    do {
        std::uint64_t left = index >> half, right = index & mask;
        for (std::uint64_t round = 0; round < 6; ++round) {
            std::uint64_t key = mix64(seed + round * 0x9e3779b97f4a7c15ull);
            std::uint64_t mixed = left ^ (mix64(right ^ key) & mask);
            left = right;
            right = mixed;
        }
        index = left << half | right;
    } while (index >= count);
    return index;
}

void frame_across(const glm::dvec3& direction, glm::dvec3& x, glm::dvec3& y) {
    // T. Duff et al., Building an orthonormal basis, revisited, JCGT 6(1), 2017.
    double sign = std::copysign(1.0, direction.z);
    double a = -1 / (sign + direction.z), b = direction.x * direction.y * a;
    x = {1 + sign * direction.x * direction.x * a, sign * b, -sign * direction.x};
    y = {b, sign + direction.y * direction.y * a, -direction.y};
}

Bundle make_bundle(const BundleSettings& settings, std::uint64_t index) {
    Random random(settings.seed, stream::bundles + index);
    Bundle bundle;
    if (settings.directions == DirectionSet::random) {
        bundle.direction = uniform_direction(random);
    } else {
        Random common(settings.seed, stream::rotation);
        const LatticePoint own = lattice_point(settings, index);
        // A line has no sense: opposite points of a whole sphere would fall between one another at
        // random. The upper half of a lattice twice as dense is even; every other one is turned.
        const glm::dvec3 up = fibonacci_direction(own.point, 2 * own.count);
        bundle.direction = glm::normalize(Rotation(common) * (own.point % 2 == 0 ? up : -up));
    }
    glm::dvec3 x, y;
    frame_across(bundle.direction, x, y);
    double turn = 2 * pi * random.uniform();
    bundle.x = std::cos(turn) * x + std::sin(turn) * y;
    bundle.y = std::cos(turn) * y - std::sin(turn) * x;
    bundle.spacing = settings.spacing;
    bundle.offset_x = random.uniform();
    bundle.offset_y = random.uniform();
    return bundle;
}

}  // namespace parallux
