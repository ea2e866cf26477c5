#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "random.h"

namespace parallux {

/// A rough mirror that reflects all: how a direction leaves it, in a frame whose z is the normal.
/// Microfacets by GGX with Smith's height-correlated shadowing, chosen among those seen
/// (E. Heitz, Sampling the GGX Distribution of Visible Normals, 2018). A facet's light that others
/// stop is given back by the lobe of C. Kulla and A. Conty (2017): reciprocal, and nothing is lost.
class Microfacets {
public:
    /// α of GGX, above 0. Takes some fifty milliseconds.
    explicit Microfacets(double alpha);

    /// Where light goes that came from unit `from`, from.z > 0: to.z > 0. `along_facet`: the cosine
    /// to the facet that reflected it; of what bounced between facets, 1 / √2, about the mean.
    glm::dvec3 sample(const glm::dvec3& from, Random& random, double& along_facet) const;

    /// The share of light from this cosine that one facet reflects and none stops.
    double single(double cosine) const;

private:
    double alpha_;
    std::vector<double> single_;  // at even roots of the cosine, 0 … 1
    double most_lost_ = 0;        // 1 - the least of them
};

}  // namespace parallux
