#pragma once

#include <cstdint>
#include <type_traits>

#include "parallux/spectrum.h"

namespace parallux {

/// Calls body with the number of bands as a constant, so that loops over bands unroll.
template <class Body>
void for_bands(std::uint32_t bands, Body&& body) {
    static_assert(max_bands == 8);
    switch (bands) {
        case 1:
            return body(std::integral_constant<std::uint32_t, 1>{});
        case 2:
            return body(std::integral_constant<std::uint32_t, 2>{});
        case 3:
            return body(std::integral_constant<std::uint32_t, 3>{});
        case 4:
            return body(std::integral_constant<std::uint32_t, 4>{});
        case 5:
            return body(std::integral_constant<std::uint32_t, 5>{});
        case 6:
            return body(std::integral_constant<std::uint32_t, 6>{});
        case 7:
            return body(std::integral_constant<std::uint32_t, 7>{});
        default:
            return body(std::integral_constant<std::uint32_t, 8>{});
    }
}

}  // namespace parallux
