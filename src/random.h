#pragma once

#include <cstdint>

// The one random generator: counter-based, so that draw k of stream s is a pure function of
// (seed, s, k) and work may be done in any order.

namespace parallux {

/// A well mixed 64-bit word of three: two rounds of the finaliser of SplitMix64 (Steele, Lea and
/// Flood, Fast Splittable Pseudorandom Number Generators, 2014; constants of Stafford's mix 13).
inline std::uint64_t mix64(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

/// Streams are parted by use, so that no two uses ever draw the same numbers.
namespace stream {
inline constexpr std::uint64_t rotation = 0;
inline constexpr std::uint64_t bundles = std::uint64_t(1) << 56;
inline constexpr std::uint64_t lines = std::uint64_t(2) << 56;
inline constexpr std::uint64_t first_shot = std::uint64_t(3) << 56;
inline constexpr std::uint64_t particles = std::uint64_t(4) << 56;
inline constexpr std::uint64_t local_gather = std::uint64_t(5) << 56;
inline constexpr std::uint64_t sensors = std::uint64_t(6) << 56;
inline constexpr std::uint64_t trial_rays = std::uint64_t(7) << 56;
inline constexpr std::uint64_t ray_steps = std::uint64_t(8) << 56;
inline constexpr std::uint64_t walks = std::uint64_t(9) << 56;         // from line to line
inline constexpr std::uint64_t shot_walks = std::uint64_t(10) << 56;   // of a first shot's rays
inline constexpr std::uint64_t light_walks = std::uint64_t(11) << 56;  // from lights without area
inline constexpr std::uint64_t path_tracer = std::uint64_t(12) << 56;
}  // namespace stream

class Random {
public:
    Random(std::uint64_t seed, std::uint64_t stream)
        : key_(mix64(mix64(seed + 0x9e3779b97f4a7c15ull) ^ (stream * 0xd1342543de82ef95ull + 1))) {}

    /// The next 64 random bits.
    std::uint64_t bits() { return mix64(mix64(key_ + 0x9e3779b97f4a7c15ull * ++counter_) ^ key_); }
    /// Uniform in [0, 1), 53 bits.
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

}  // namespace parallux
