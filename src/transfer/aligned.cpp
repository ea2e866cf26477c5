#include "parallux/aligned.h"

#include <sys/mman.h>

namespace parallux {

namespace {

constexpr std::align_val_t cache_line{64}, huge_page{std::size_t(2) << 20};

std::align_val_t alignment_of(std::size_t bytes) {
    return bytes < 4 * static_cast<std::size_t>(huge_page) ? cache_line : huge_page;
}

}  // namespace

void* allocate_aligned(std::size_t bytes) {
    const std::align_val_t alignment = alignment_of(bytes);
    void* place = ::operator new(bytes, alignment);
    // Whole pages only: the rest would be rounded up. Where it is refused nothing is lost but time.
    if (alignment == huge_page)
        madvise(place,
                bytes / static_cast<std::size_t>(huge_page) * static_cast<std::size_t>(huge_page),
                MADV_HUGEPAGE);
    return place;
}

void free_aligned(void* place, std::size_t bytes) {
    ::operator delete(place, alignment_of(bytes));
}

}  // namespace parallux
