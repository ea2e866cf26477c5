#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "throughput/embree_scene.h"
#include "throughput/engine.h"

namespace parallux::throughput {

/// Hits of one line at the most; a longer list ends the program, it is never cut.
inline constexpr std::uint32_t most_hits = 2048;

/// One line's, or one packet lane's, place for its hits.
struct HitArray {
    std::uint32_t count = 0;
    RawHit hits[most_hits];
    // Arrays that lie a power of two apart would all begin in one set of the cache.
    char apart[60];
};

/// A query, with Embree's context in front: the filter finds its arrays behind it.
struct Query {
    RTCIntersectContext context;
    std::uint32_t first_of[2];
    HitArray* lanes;
};

/// Keeps every crossing and lets none end the ray; the ray's id is its lane.
void keep_all(const RTCFilterFunctionNArguments* arguments);

/// Sorts the hits of one line by distance and appends them as a list.
void append_sorted(const EmbreeScene& scene, HitArray& array, IntersectionLists& lists);

/// What both Embree engines have in common: the choices, tried one by one.
class EmbreeEngine : public Engine {
public:
    std::string choice() const override;

protected:
    EmbreeEngine(const Case& of, Parts parts, bool whole)
        : case_(of), parts_(parts), whole_(whole) {}

    /// Tries all choices by `trial` on one thread and stays with the fastest.
    void choose(const std::vector<int>& columns, const std::function<Measured()>& trial);
    /// Lines that take a good third of a second.
    double enough_lines(unsigned threads) const { return 0.35 * threads * rate_; }
    Query query(HitArray* lanes, RTCIntersectContextFlags coherence) const;

    const Case& case_;
    const Parts parts_;
    const bool whole_;
    EmbreeChoice choice_;
    std::shared_ptr<const EmbreeScene> scene_;
    double rate_ = 0;  ///< lines a second in the trial
};

}  // namespace parallux::throughput
