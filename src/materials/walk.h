#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lines/ray_scene.h"
#include "materials/bounce.h"
#include "parallux/patches.h"

namespace parallux {

/// What local walks in a scene with mirrors and glass go by. Immutable after construction.
class Walks {
public:
    /// Keeps references to all.
    Walks(const Scene& scene, const Patches& patches, const RayScene& rays);

    const Scene& scene;
    const Patches& patches;
    const RayScene& rays;
    /// Of a material; null where it is smooth.
    const Microfacets* rough(std::uint32_t material) const { return rough_[material].get(); }

private:
    std::vector<std::shared_ptr<const Microfacets>> rough_;
};

/// One walk of light from surface to surface, forward along power or back along sight: advance()
/// to what lies ahead, bounce() off it as long as its specular part has a share.
class Walk {
public:
    /// Bounces, at most: light between perfect mirrors would never end.
    static constexpr int most_bounces = 10000;

    /// From a point along a unit direction; the surface `skip` is not met first.
    Walk(const Walks& walks, const glm::dvec3& origin, const glm::dvec3& direction,
         std::uint32_t skip = none)
        : walks_(walks), origin_(origin), direction_(direction), skip_(skip) {}

    /// False: nothing lies ahead. `passed` is multiplied by what glass on the way let through.
    bool advance(Weights& passed);
    /// What was met, its patch (none: an inert back), and the share that does not meet its diffuse
    /// part.
    const SurfaceHit& hit() const { return hit_; }
    std::uint32_t patch() const { return patch_; }
    double share() const { return share_; }
    const glm::dvec3& direction() const { return direction_; }

    /// Leaves by the specular part. `passed` is multiplied by what it leaves of power. Returns what
    /// radiance is multiplied by beside it. Once most_bounces are made nothing passes.
    double bounce(Random& random, Weights& passed);

private:
    const Walks& walks_;
    glm::dvec3 origin_, direction_;
    std::uint32_t skip_;
    std::uint32_t medium_ = none;  // the material of glass that it is inside
    SurfaceHit hit_;
    std::uint32_t patch_ = none;
    double share_ = 0;
    int bounces_ = 0;
};

/// Whole quanta a band.
using Quanta = std::array<std::int64_t, max_bands>;

/// Where quanta of a walk go; every one of them goes somewhere.
struct QuantaSink {
    std::function<void(std::uint32_t patch, const Quanta&)> land;  ///< on a patch's diffuse part
    std::function<void(const Quanta&)> escape;  ///< out of the scene, or onto an inert back
    std::function<void(const Quanta&)> lose;    ///< absorbed by mirrors and glass
};

/// Traces power on until all of it is on diffuse patches, absorbed or out. Of what a surface leaves
/// of it, at first that share goes on; once little is left, all or nothing, by Russian roulette
/// with that share as its chance, so that no quantum is ever made. Right in the mean.
void carry(Walk walk, Quanta quanta, std::uint32_t bands, Random& random, const QuantaSink& sink);

/// Follows sight back: visit(patch, weights) of every patch whose radiosity is seen, escape
/// (direction, weights) where the sky is. Σ weights · radiance is what is seen, in the mean, when
/// `weights` are those to begin with.
void follow_sight(Walk walk, Weights weights, std::uint32_t bands, Random& random,
                  const std::function<void(const Walk&, const Weights&)>& visit,
                  const std::function<void(const glm::dvec3&, const Weights&)>& sky);

}  // namespace parallux
