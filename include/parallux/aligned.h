#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace parallux {

/// Memory that begins at a multiple of 64 bytes, so that no element of 2ᵏ bytes crosses a cache
/// line.
template <class T>
struct CacheAligned {
    using value_type = T;
    static constexpr std::align_val_t alignment{64};

    CacheAligned() = default;
    template <class U>
    CacheAligned(const CacheAligned<U>&) {}

    T* allocate(std::size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T), alignment));
    }
    void deallocate(T* place, std::size_t) { ::operator delete(place, alignment); }
    bool operator==(const CacheAligned&) const { return true; }
};

using QuantaArray = std::vector<std::int64_t, CacheAligned<std::int64_t>>;

}  // namespace parallux
