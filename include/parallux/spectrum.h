#pragma once

#include <array>
#include <cstdint>

namespace parallux {

/// The most bands one solve can carry.
inline constexpr std::uint32_t max_bands = 8;

/// π, here and nowhere else. E = π L joins a diffuse surface's exitance E to its radiance L.
inline constexpr double pi = 3.14159265358979323846;

/// "No such index": an absent patch, texture or material.
inline constexpr std::uint32_t none = 0xffffffffu;

/// One value a band. The scene says how many of the places are in use; the rest are zero.
struct Spectrum {
    std::array<float, max_bands> value{};

    float& operator[](std::size_t band) { return value[band]; }
    float operator[](std::size_t band) const { return value[band]; }
    bool operator==(const Spectrum&) const = default;

    /// The same value in every place.
    static Spectrum constant(float v) {
        Spectrum s;
        s.value.fill(v);
        return s;
    }
};

}  // namespace parallux
