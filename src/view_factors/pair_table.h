#pragma once

#include <cstdint>
#include <vector>

#include "random.h"

namespace parallux {

/// Counts by 64-bit keys, in a table of open places: those of the current group of bundles, and
/// those of all groups before. Takes 24 bytes a place, of which up to three quarters are in use.
class PairTable {
public:
    static constexpr std::uint64_t empty = ~std::uint64_t(0);
    struct Place {
        std::uint64_t key = empty, current = 0, before = 0;
    };

    void add(std::uint64_t key, std::uint64_t count) {
        if (4 * (used_ + 1) > 3 * places_.size())
            grow();
        Place& place = find(key);
        used_ += place.key == empty;
        place.key = key;
        place.current += count;
    }
    /// The processor may fetch the place already.
    void announce(std::uint64_t key) const {
        if (!places_.empty())
            __builtin_prefetch(&places_[first_place(key)]);
    }

    std::vector<Place>& places() { return places_; }
    std::uint64_t used() const { return used_; }
    std::uint64_t bytes() const { return places_.size() * sizeof(Place); }
    void release() {
        places_ = {};
        used_ = 0;
    }

private:
    std::size_t first_place(std::uint64_t key) const {
        return static_cast<std::size_t>(
            (static_cast<unsigned __int128>(mix64(key)) * places_.size()) >> 64);
    }
    Place& find(std::uint64_t key) {
        std::size_t k = first_place(key);
        while (places_[k].key != empty && places_[k].key != key)
            k = k + 1 == places_.size() ? 0 : k + 1;
        return places_[k];
    }
    void grow() {
        std::vector<Place> old(64 + places_.size() / 2 * 3);
        old.swap(places_);
        for (const Place& place : old)
            if (place.key != empty)
                find(place.key) = place;
    }

    std::vector<Place> places_;
    std::uint64_t used_ = 0;
};

}  // namespace parallux
