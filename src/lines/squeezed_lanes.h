#pragma once

#include <cstdint>

namespace parallux {

/// Of eight lanes, the places of those whose bit is set, in order, then of the others.
struct SqueezedLanes {
    alignas(64) std::uint8_t of[256][8];

    constexpr SqueezedLanes() : of{} {
        for (unsigned bits = 0; bits < 256; ++bits) {
            unsigned place = 0;
            for (unsigned set : {1u, 0u})
                for (unsigned lane = 0; lane < 8; ++lane)
                    if ((bits >> lane & 1) == set)
                        of[bits][place++] = static_cast<std::uint8_t>(lane);
        }
    }
};
inline constexpr SqueezedLanes squeezed_lanes;

}  // namespace parallux
