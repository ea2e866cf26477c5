#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace parallux {

/// Memory of at least `bytes`, and how to give it back. It begins at a multiple of 64 bytes; what
/// is larger than some MiB lies in pages of 2 MiB where the system has them, because arrays that
/// are met at random places would else miss the processor's table of pages at every other access.
void* allocate_aligned(std::size_t bytes);
void free_aligned(void* place, std::size_t bytes);

/// Arrays in such memory: no element of 2ᵏ bytes crosses a cache line.
template <class T>
struct CacheAligned {
    using value_type = T;

    CacheAligned() = default;
    template <class U>
    CacheAligned(const CacheAligned<U>&) {}

    T* allocate(std::size_t count) { return static_cast<T*>(allocate_aligned(count * sizeof(T))); }
    void deallocate(T* place, std::size_t count) { free_aligned(place, count * sizeof(T)); }
    bool operator==(const CacheAligned&) const { return true; }
};

template <class T>
using AlignedArray = std::vector<T, CacheAligned<T>>;

}  // namespace parallux
