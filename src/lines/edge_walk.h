#pragma once

#include <cstdint>
#include <utility>

namespace parallux {

/// Fixed-point places a line spacing: corners are snapped to 1 / fixed_one of it.
inline constexpr int fixed_bits = 12;
inline constexpr std::int64_t fixed_one = std::int64_t(1) << fixed_bits;

/// First whole line at or after a fixed-point coordinate.
inline std::int32_t first_line(std::int64_t fixed) {
    return static_cast<std::int32_t>((fixed + fixed_one - 1) >> fixed_bits);
}

/// Walks down one edge and tells for each row the first column at or right of it, exactly: with
/// D = y1 - y0 and N = (row - y0)(x1 - x0), the edge is at x0 + N / D. Both ends are integers, and
/// the lower end always comes first, so that two faces with a common edge get the same columns and
/// part the lines between them (a top-left rule: rows and columns are half open).
class EdgeWalk {
public:
    /// Starts at the first row of the edge that is not above `row`; coordinates in fixed point.
    EdgeWalk(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1, std::int32_t row) {
        if (y0 > y1) {
            std::swap(x0, x1);
            std::swap(y0, y1);
        }
        first_ = first_line(y0);
        end_ = first_line(y1);
        if (first_ < row)
            first_ = row;
        if (first_ >= end_)
            return;
        x0_ = x0;
        height_ = y1 - y0;
        width_ = x1 - x0;
        std::int64_t n = ((static_cast<std::int64_t>(first_) << fixed_bits) - y0) * width_;
        floor_divide(n, height_, whole_, rest_);
        if (end_ - first_ > 1)
            floor_divide(width_ * fixed_one, height_, step_whole_, step_rest_);
    }

    std::int32_t first_row() const { return first_; }
    std::int32_t end_row() const { return end_; }

    /// First column at or right of the edge in the present row.
    std::int32_t column() const {
        return static_cast<std::int32_t>((x0_ + whole_ + fixed_one - (rest_ == 0)) >> fixed_bits);
    }

    void next_row() {
        whole_ += step_whole_;
        rest_ += step_rest_;
        if (rest_ >= height_) {
            rest_ -= height_;
            ++whole_;
        }
    }

private:
    static void floor_divide(std::int64_t n, std::int64_t d, std::int64_t& whole,
                             std::int64_t& rest) {
        whole = n / d;
        rest = n % d;
        if (rest < 0) {
            rest += d;
            --whole;
        }
    }

    std::int32_t first_ = 0, end_ = 0;
    std::int64_t x0_ = 0, height_ = 1, width_ = 0;
    std::int64_t whole_ = 0, rest_ = 0, step_whole_ = 0, step_rest_ = 0;
};

}  // namespace parallux
