#pragma once

#include "materials/walk.h"
#include "parallux/lines.h"
#include "parallux/transfer.h"
#include "solve/run.h"

namespace parallux {

/// Follows a bundle's lists where some surfaces mirror or are glass. What a line brings to one of
/// those goes on from there as a local walk, of random numbers that are a function of the line
/// alone; everything else is as in exchange(), both ways.
class LineWalks {
public:
    /// `gathers`: every exit collects what its line sees, as far as its patch is diffuse, in place
    /// of sending what it carries. `sky`: as LineSweep has it. Keeps references to run and state.
    LineWalks(const Run& run, const TransferState& state, bool gathers, double sky,
              unsigned worker);

    /// The lists of one tile, of a scene about `centre`. `kept`, where not null, gets the pairs of
    /// patches that exchange, a walk's two ends among them, with so many of those as there would be
    /// if each way counted half. About so where surfaces are partly diffuse: what is left over
    /// after a pass has no need of more.
    void follow(const Projection& projection, std::size_t tile, const IntersectionLists& lists,
                const glm::dvec3& centre, TilePairs* kept);

private:
    struct End {
        std::uint32_t patch, surface;
        glm::dvec3 point;
    };
    void follow_line(const Hit* hits, std::size_t count, const glm::dvec3& base);
    void exchange(const End& from, const End& to, const glm::dvec3& direction);
    void leave_scene(const End& from, const glm::dvec3& direction, const std::int64_t* sky);
    void enter_scene(std::uint32_t patch, const glm::dvec3& base, const glm::dvec3& direction,
                     const std::int64_t* sky);
    Walk leave(const End& from, const glm::dvec3& direction) const;
    void send(const End& from, std::uint32_t to, const glm::dvec3& direction);
    void collect(const End& from, std::uint32_t to, const glm::dvec3& direction);
    void keep_walk(std::uint32_t from);

    double share(std::uint32_t patch) const { return run_.patches.specular_share(patch); }
    const std::int32_t* carried(std::uint32_t patch) const {
        return state_.carried.data() + patch * std::size_t(lanes(bands_));
    }
    Quanta quanta_of(std::uint32_t patch) const;

    const Run& run_;
    const TransferState& state_;
    const bool gathers_;
    const double sky_;
    const unsigned worker_;
    const std::uint32_t bands_;
    WorkerTotals& totals_;
    QuantaSink sink_, watched_;
    // Of the line at hand.
    glm::dvec3 along_{0};
    double radius_ = 0;
    SkyQuanta outside_;
    Random random_;
    TilePairs* kept_ = nullptr;
    // Of a walk that is kept: where it lands, chosen by power; whether its quanta are none.
    bool pretends_ = false;
    double until_ = 0;
    std::uint32_t landed_ = none;
};

}  // namespace parallux
