#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "parallux/patches.h"

// What a material does with arriving energy, here and nowhere else: a share ρ leaves from where it
// arrived, a share τ from the other side, and the rest is absorbed. k = patch * bands + band.

namespace parallux {

/// What leaves k of all that arrives, ρ_k H_k + τ_q H_q with q the other side: B = E + this.
/// arriving(k): H.
template <class Arriving>
double scattered(const Patches& patches, std::size_t k, Arriving&& arriving) {
    double sum = static_cast<double>(patches.reflectance[k]) * arriving(k);
    if (!patches.translucent())
        return sum;
    const std::size_t q = patches.across(k);
    return q == Patches::no_side
               ? sum
               : sum + static_cast<double>(patches.transmittance[q]) * arriving(q);
}

/// The quanta of it that stay on k's own side, and those that go through.
inline std::int64_t reflected_quanta(const Patches& patches, std::size_t k, std::int64_t arrived) {
    return std::llrint(static_cast<double>(patches.reflectance[k]) * static_cast<double>(arrived));
}
inline std::int64_t transmitted_quanta(const Patches& patches, std::size_t k,
                                       std::int64_t arrived) {
    return std::llrint(static_cast<double>(patches.transmittance[k]) *
                       static_cast<double>(arrived));
}

/// scattered() in quanta: every share is rounded by itself, so that what all patches send is what
/// passed_on() says of all.
template <class Arrived>
std::int64_t scattered_quanta(const Patches& patches, std::size_t k, Arrived&& arrived) {
    const std::int64_t sum = reflected_quanta(patches, k, arrived(k));
    if (!patches.translucent())
        return sum;
    const std::size_t q = patches.across(k);
    return q == Patches::no_side ? sum : sum + transmitted_quanta(patches, q, arrived(q));
}

/// Of quanta that arrived on k, what leaves again from either side; the rest is absorbed.
inline std::int64_t passed_on(const Patches& patches, std::size_t k, std::int64_t arrived) {
    const std::int64_t sum = reflected_quanta(patches, k, arrived);
    return patches.translucent() ? sum + transmitted_quanta(patches, k, arrived) : sum;
}

}  // namespace parallux
