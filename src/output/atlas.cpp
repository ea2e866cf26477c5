#include "output/atlas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace parallux {

std::uint64_t pack_shelves(std::vector<AtlasRect>& rectangles, std::uint32_t width) {
    constexpr std::uint64_t impossible = std::numeric_limits<std::uint64_t>::max();
    std::vector<std::uint32_t> order(rectangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return rectangles[a].height > rectangles[b].height;
    });
    std::uint64_t top = 0, shelf = 0, x = 0;
    for (std::uint32_t i : order) {
        AtlasRect& rectangle = rectangles[i];
        if (rectangle.width > width)
            return impossible;
        if (x + rectangle.width > width)
            top += shelf, x = 0, shelf = 0;
        shelf = std::max<std::uint64_t>(shelf, rectangle.height);
        rectangle.x = static_cast<std::uint32_t>(x);
        rectangle.y = static_cast<std::uint32_t>(top);
        x += rectangle.width;
        if (top + shelf > std::numeric_limits<std::uint32_t>::max())
            return impossible;
    }
    return top + shelf;
}

std::uint32_t shelf_width(const std::vector<AtlasRect>& rectangles) {
    double area = 0;
    std::uint32_t widest = 2;
    for (const AtlasRect& r : rectangles) {
        area += double(r.width) * r.height;
        widest = std::max(widest, r.width);
    }
    double side = std::min(std::ceil(0.5 * std::sqrt(1.05 * area)), 1e9);
    return std::max(widest, 2 * static_cast<std::uint32_t>(side));
}

}  // namespace parallux
