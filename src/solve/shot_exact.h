#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "lines/ray_scene.h"
#include "solve/emitters.h"
#include "solve/run.h"
#include "solve/sources.h"

namespace parallux {

/// Direct light by form factors. Where nothing can stand between a source and a cell, their factor
/// is exact, found once, and the same in every shot. Where something can, the cell's factor is a
/// mean over random points, drawn anew for every shot, so that the spread of shots tells its error:
/// in scenes of few surfaces, of the form factor from the point to what it sees of the source, in
/// closed form; in others, the factor times the share of shadow rays between source and cell that
/// arrive. Sources that other surfaces lie on send rays. Cells of one surface that emit alike are
/// one source.
class ExactShot {
public:
    /// Up to so many surfaces, what is hidden is cut away in closed form.
    static constexpr std::size_t few_surfaces = 256;

    /// Of what a source sees, about; with a few surfaces between.
    static constexpr std::uint64_t bytes_a_cell() { return sizeof(Pair) + 4; }

    /// All cells of the scene; shots from one patch after the other share them.
    using Cells = std::shared_ptr<const std::vector<Emitter>>;

    /// Sorts out which cells see which sources, and how many points or rays each pair that may be
    /// hidden will take. Keeps the references. O(sources · cells), in parallel: 0.5 to 5 µs a pair
    /// that faces each other. `go_on` is asked after each source; where it says false, the others
    /// are left out of all shots.
    ExactShot(const Scene& scene, const Patches& patches, const RayScene& rays, Cells cells,
              const Emitters& emitters, unsigned threads, const std::function<bool()>& go_on);

    /// Sends all power into the banks, and adds to the totals of what was emitted and escaped; all
    /// that is emitted is received or escapes, to the last quantum. In a scene that lets nothing
    /// out, what was found at random is scaled so that all is received. Begins behind the first
    /// `done` sources, which counts on; `go_on(share)` is asked after each, false stops. Returns
    /// the share of the power that was sent.
    double shoot(const Run& run, std::vector<std::int64_t>& emitted,
                 std::vector<std::int64_t>& escaped, std::uint64_t& done,
                 const std::function<bool(double)>& go_on) const;

private:
    // A source and a cell with something between them.
    struct Pair {
        std::uint32_t cell;
        std::uint32_t samples;          // a grid's side in points; or rays; with an effort of 1
        std::uint32_t first, blockers;  // in blockers_; first of rays: none
        double factor;                  // with nothing between; of rays

        bool by_rays() const { return first == none; }
    };
    // A cell that all of a source arrives at which is sent there.
    struct Seen {
        std::uint32_t cell;
        double factor;
    };
    // Of one source.
    struct View {
        std::vector<Seen> seen;
        std::vector<Pair> pairs;
        double sum = 0;       // of what is seen
        bool closed = false;  // nothing escapes
        // Something lies on the source: what a gap without depth exchanges has no form factor.
        bool by_rays = false;
    };
    struct Chunk;

    const std::vector<Emitter>& cells() const { return *cells_; }
    View view_of(std::size_t source);
    void look(std::size_t source, std::size_t begin, std::size_t end, Chunk& chunk) const;
    bool covered_in_part(const Emitter& side, const Polygon& part) const;
    std::vector<std::uint32_t> met_by_rays(std::size_t source, std::uint64_t seed,
                                           double effort) const;
    std::vector<double> factors_of(std::size_t source, std::uint64_t seed, double effort) const;
    bool sees_only_patches(const Source& source) const;
    double power_share(std::size_t sources) const;

    const Scene& scene_;
    const Patches& patches_;
    const RayScene& rays_;
    Cells cells_;
    unsigned threads_;
    std::vector<Source> sources_;
    std::vector<Polygon> surfaces_;        // that may hide, where they are few; else empty
    std::vector<std::uint32_t> blockers_;  // surfaces
    std::vector<View> views_;
};

}  // namespace parallux
