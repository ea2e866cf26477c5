#pragma once

#include <Eigen/Core>

#include "reference/exact_factors.h"
#include "support/hand_made.h"
#include "support/seeds.h"

namespace parallux::test {

/// A room with nothing in between, so that its factors are known in closed form.
struct BareRoom {
    explicit BareRoom(Scene of) : scene(std::move(of)) {}

    Scene scene;
    Patches patches = make_patches(scene);
    Eigen::VectorXd exact = exact_radiosity(exact_factors(scene, patches), patches);

    double truth(std::size_t patch) const { return exact[Eigen::Index(patch)]; }

    /// Area-weighted mean square of what a run is off by, of all patches or of those that do not
    /// emit.
    double quadratic_error(const std::vector<float>& run, bool emitters = true) const {
        double sum = 0, area = 0;
        for (std::size_t k = 0; k < run.size(); ++k) {
            if (!emitters && patches.emission[k] > 0)
                continue;
            sum += patches.area[k] * std::pow(run[k] - truth(k), 2);
            area += patches.area[k];
        }
        return sum / area;
    }
};

/// Unequal walls, a lamp at one end.
inline BareRoom unequal_room() {
    return BareRoom(room({grey(0.5, 1), grey(0.3), grey(0.6), grey(0.5), grey(0.7), grey(0.4)}, 4,
                         glm::dvec3(0), glm::dvec3(1.5, 1, 0.75)));
}

/// A bright cube, one face of which emits.
inline BareRoom bright_room() {
    Material wall = grey(0.8);
    return BareRoom(room({wall, wall, grey(0.8, 1), wall, wall, wall}, 4));
}

}  // namespace parallux::test
