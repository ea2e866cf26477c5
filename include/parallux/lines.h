#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "parallux/patches.h"
#include "parallux/scene.h"

// Stages 3 and 4: lines through the whole scene, and what each meets in order.

namespace parallux {

enum class DirectionSet { lattice, random };

/// Parallel lines on a square lattice across `direction`. Line (column, row) passes through
/// centre + spacing ((column - offset_x) x + (row - offset_y) y), column and row any integers.
struct Bundle {
    glm::dvec3 direction{0, 0, 1};  ///< unit
    glm::dvec3 x{1, 0, 0};          ///< unit, across direction
    glm::dvec3 y{0, 1, 0};          ///< unit, x × y = direction
    double spacing = 1;             ///< δ, metres
    double offset_x = 0;            ///< in spacings, [0, 1)
    double offset_y = 0;
};

struct BundleSettings {
    std::uint64_t seed = 1;
    std::uint64_t count = 1;  ///< D, of the whole run: the lattice has so many points
    DirectionSet directions = DirectionSet::lattice;
    double spacing = 1;  ///< δ, metres
    /// The lattice has half as many points; half of these come twice in the first half of the
    /// bundles, the others in the second, so that directions within a half are as good as
    /// independent.
    bool twice = false;
};

/// Bundle `index` of a run: a pure function of its arguments. Directions are half of a spherical
/// Fibonacci lattice of 2 · `count` points under one random rotation, every other one turned about,
/// shuffled; or independent and uniform. The rotation in the plane and the offset are random for
/// each bundle.
Bundle make_bundle(const BundleSettings& settings, std::uint64_t index);

/// One crossing of a line and a surface. `toward` is the patch on the side that a traveller along
/// the direction sees when coming near, `away` the one seen when looking back; none: that side is
/// the inert back of a one-sided surface.
struct Hit {
    float depth = 0;  ///< grows along the direction
    std::uint32_t surface = none;
    std::uint32_t toward = none;
    std::uint32_t away = none;
};

/// The ordered hits of some lines: those of line k are hits[start[k]] … hits[start[k + 1] - 1], by
/// depth, ties by surface.
struct IntersectionLists {
    std::vector<std::uint32_t> start{0};
    std::vector<Hit> hits;

    std::size_t lines() const { return start.size() - 1; }
};

/// Patches one after the other; `ids` is longer than `count`.
struct PatchList {
    std::vector<std::uint32_t> ids;
    std::size_t count = 0;
};

/// What the lists of some lines come to when nothing but neighbours matters: who exchanges with
/// whom.
struct TilePairs {
    PatchList from, to;    ///< from[k] and to[k] face each other on a line, in its direction
    PatchList first;       ///< patches that a line comes upon from outside the scene
    PatchList last;        ///< patches from which a line leaves it
    PatchList into_backs;  ///< patches whose neighbour along the direction is an inert back
    PatchList from_backs;  ///< patches whose neighbour against the direction is one
    std::uint64_t lines = 0, nonempty = 0, hits = 0, odd = 0;

    void clear();
    /// Makes room for so many more hits.
    void reserve(std::size_t more_hits);

    /// Where the lists stand, and back to there.
    struct Mark {
        std::size_t from, first, last, into_backs, from_backs;
        std::uint64_t nonempty, hits, odd;
    };
    Mark mark() const;
    void back_to(const Mark& mark);
};

/// The pairs of ordered lists; appended.
void append_pairs(const IntersectionLists& lists, TilePairs& pairs);

/// A bundle's view of the scene: snapped corners and the surfaces of every tile.
struct Projection {
    Bundle bundle;
    double radius = 1;                               ///< of the scene, metres
    std::int32_t left = 0, top = 0;                  ///< first column and row
    std::int32_t columns = 0, rows = 0;              ///< of the rectangle that holds the scene
    std::int32_t tile_columns = 64, tile_rows = 64;  ///< of a tile; powers of two
    std::int32_t tiles_x = 0, tiles_y = 0;
    struct Corner {
        std::int32_t x, y;  ///< fixed point, 1 / fixed_one of a spacing
        float depth;        ///< in radii of the scene from its centre
    };
    std::vector<Corner> corners;  ///< one a position of the scene
    /// A whole sphere: x, y and radius in spacings, not snapped; depth in radii of the scene, as
    /// much more a spacing; the bundle's axes as the sphere's own frame has them.
    struct Ball {
        double x, y, radius, depth, per_spacing;
        glm::mat3 axes;
        bool turned;  ///< its grid's v runs against the angle
    };
    std::vector<Ball> balls;                ///< one a curve of the scene
    std::vector<std::uint32_t> tile_start;  ///< tiles + 1 offsets into tile_surfaces
    std::vector<std::uint32_t> tile_surfaces;
    std::vector<std::uint32_t> order;  ///< all surfaces by depth, where planes can tell; else empty

    /// Scratch: some of the surfaces, with the tiles they may meet.
    struct TileEntry {
        std::uint32_t tile, surface;
    };
    struct Piece {
        std::vector<TileEntry> entries;
        std::vector<std::uint32_t> place;  ///< one a tile
    };
    std::vector<Piece> pieces;

    std::size_t tiles() const { return static_cast<std::size_t>(tiles_x) * tiles_y; }
    std::uint64_t lines() const { return static_cast<std::uint64_t>(columns) * rows; }
};

class PlaneSides;
struct Facets;

/// Columns left … right - 1 and rows top … bottom - 1 of a bundle.
struct LineWindow {
    std::int32_t left = INT32_MIN, right = INT32_MAX, top = INT32_MIN, bottom = INT32_MAX;
};

/// Finds all crossings of a bundle by rasterising the surfaces. Corners are snapped to a grid of
/// 1/4096 spacing and rows are filled by exact integer arithmetic, half open on either side, so
/// that two faces with a common edge leave no line out and share none: every line meets a closed
/// surface an even number of times. Immutable after construction; queries run on any thread.
class Projector {
public:
    /// many: does not look for an order of the surfaces' planes, which takes longer than a bundle.
    enum class Surfaces { any, many };
    /// Keeps references to both: they must outlive the projector. Whole spheres are met where they
    /// are, to a float's digits, and in the right cells. Other curved surfaces are cut into flat
    /// triangles once, for bundles of about the spacing that is given here (0: a thousandth of the
    /// scene's radius): their hits lie within an eighth of it of where they should, and in the
    /// right cells but for that; outlines and areas are less by 5·10⁻⁴ at most. That they are met
    /// an even number of times holds as exactly as for planar ones.
    Projector(const Scene& scene, const Patches& patches, Surfaces surfaces = Surfaces::any,
              double spacing = 0);

    /// Projects corners and sorts surfaces into tiles, in parallel where they are many. Linear in
    /// corners, surfaces and the tiles they cover. Throws Fault::usage when the spacing gives more
    /// than 2¹⁸ lines a side. With a window, only lines in it are looked at.
    void project(const Bundle& bundle, Projection& projection, unsigned threads = 1,
                 const LineWindow* window = nullptr) const;

    /// Scratch of one thread.
    struct Workspace;
    std::shared_ptr<Workspace> make_workspace() const;

    /// The lists of one tile, line = (row in tile) · (columns in tile) + column.
    void lists(const Projection& projection, std::size_t tile, Workspace& workspace,
               IntersectionLists& lists) const;

    /// The same lines as pairs. Where surfaces are few they are followed in the order of their
    /// planes, without lists; lines for which that order is not certain are looked at by lists().
    void pairs(const Projection& projection, std::size_t tile, Workspace& workspace,
               TilePairs& pairs) const;

    const glm::dvec3& centre() const { return centre_; }
    double radius() const { return radius_; }

private:
    void sort_into_tiles(Projection& projection, unsigned threads) const;
    void paint_pairs(const Projection& projection, std::size_t tile, Workspace& workspace,
                     TilePairs& pairs) const;
    void layer_pairs(const Projection& projection, std::size_t tile, Workspace& workspace,
                     TilePairs& pairs) const;
    // Orders the list that begins there in the workspace, and ends it.
    void order_list(const Projection& projection, std::int32_t column, std::int32_t row,
                    std::size_t begin, Workspace& workspace) const;

    std::shared_ptr<const Facets> facets_;  // null: there are no curved surfaces
    const Scene& scene_;                    // whose surfaces are projected
    const Patches& patches_;
    glm::dvec3 centre_{0};
    double radius_ = 0;
    std::shared_ptr<const PlaneSides> sides_;          // null: too many surfaces
    std::shared_ptr<const std::vector<bool>> sheets_;  // surfaces that are a face of one
};

/// Throws Fault::usage when a spacing gives more than 2¹⁸ lines across a scene of this radius.
void check_spacing(double spacing, double radius);

class RayScene;

/// Independent lines, uniform (isotropic, homogeneous) through a sphere about the scene.
struct LineSphere {
    glm::dvec3 centre{0};
    double radius = 0;
};

/// The sphere of a scene: about the middle of its bounds, of the wanted radius, or the one that
/// just holds it when that is 0. Throws Fault::usage when the wanted radius does not hold the
/// scene.
LineSphere line_sphere(const Scene& scene, double wanted_radius = 0);

/// The lists of lines first … first + count - 1 of a run, by Embree in robust mode; each line a
/// pure function of (seed, its number). `directions`, where given, gets that of every line.
void trace_lines(const RayScene& rays, const Scene& scene, const Patches& patches,
                 const LineSphere& sphere, std::uint64_t seed, std::uint64_t first,
                 std::size_t count, IntersectionLists& lists,
                 std::vector<glm::dvec3>* directions = nullptr);

}  // namespace parallux
