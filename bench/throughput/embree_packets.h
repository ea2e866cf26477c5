#pragma once

#include "throughput/bundle_lines.h"
#include "throughput/embree_engine.h"

namespace parallux::throughput {

/// Engine (c): the very lines of the bundles, 16 neighbours at a time, on the parent surfaces.
class EmbreePackets : public EmbreeEngine {
public:
    EmbreePackets(const Case& of, bool whole);

    const char* name() const override { return "embree-packets"; }
    Measured run(unsigned threads) override;
    std::string choice() const override;

    /// About so many lines, or all: whole bundles where they are small, else some tiles of each of
    /// many bundles, so that directions and places are as mixed as in the solve.
    Measured trace(unsigned threads, double lines) const;

private:
    struct Lanes;
    struct View;
    struct Tile {
        std::size_t view, tile;
    };

    static std::vector<Tile> choose_tiles(const std::vector<View>& views, std::size_t first,
                                          double share);
    void trace_tile(const View& view, std::size_t tile, Lanes& lanes,
                    IntersectionLists& lists) const;

    std::vector<Bundle> bundles_;
    std::vector<LineRectangle> rectangles_;
};

}  // namespace parallux::throughput
