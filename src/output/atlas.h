#pragma once

#include <cstdint>
#include <vector>

namespace parallux {

/// A rectangle of whole texels to be placed, and where it came to lie.
struct AtlasRect {
    std::uint32_t width = 0, height = 0;
    std::uint32_t x = 0, y = 0;
};

/// Places rectangles on shelves, tallest first, in a picture so wide; returns the height needed.
/// No two overlap. Equal rectangles keep their order. n log n.
std::uint64_t pack_shelves(std::vector<AtlasRect>& rectangles, std::uint32_t width);

/// A width that makes the shelves about square: even, at least the widest rectangle's.
std::uint32_t shelf_width(const std::vector<AtlasRect>& rectangles);

}  // namespace parallux
