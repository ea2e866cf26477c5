#pragma once

#include "throughput/embree_engine.h"

namespace parallux::throughput {

/// Engines (a) and (b): independent lines, the very ones of trace_lines(), each a single ray.
class EmbreeLines : public EmbreeEngine {
public:
    EmbreeLines(const Case& of, Parts parts, bool whole);

    const char* name() const override {
        return parts_ == Parts::patches ? "embree-lines" : "embree-lines-parents";
    }
    Measured run(unsigned threads) override;

    /// Lines first … first + count - 1.
    Measured trace(unsigned threads, std::uint64_t first, std::uint64_t count) const;
    /// As many as the bundle engine casts.
    std::uint64_t all_lines() const;

private:
    void trace_piece(const LineSphere& sphere, std::uint64_t first, std::size_t count,
                     HitArray& array, IntersectionLists& lists) const;
};

}  // namespace parallux::throughput
