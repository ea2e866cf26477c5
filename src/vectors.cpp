#include "vectors.h"

#include <cstdint>
#include <cstring>

#include <hwy/targets.h>

namespace parallux {

namespace {

constexpr const char* names[] = {"plain", "sse4", "avx2", "avx512"};
// Highway's targets that make up each set beyond the one before it.
constexpr std::int64_t targets[] = {HWY_SCALAR, HWY_SSSE3 | HWY_SSE4, HWY_AVX2,
                                    HWY_AVX3 | HWY_AVX3_DL};
constexpr std::int64_t telling[] = {HWY_SCALAR, HWY_SSE4, HWY_AVX2, HWY_AVX3};

}  // namespace

std::span<const char* const> vector_sets() {
    return names;
}

const char* vectors_in_use() {
    std::size_t use = 0;
    for (std::size_t k = 1; k < std::size(names); ++k)
        if (hwy::SupportedTargets() & telling[k])
            use = k;
    return names[use];
}

bool use_vectors(const char* set) {
    auto allow = [](std::int64_t allowed) {
        hwy::SetSupportedTargetsForTest(allowed);
        hwy::GetChosenTarget().DeInit();  // what was chosen is chosen again
    };
    allow(0);  // whatever the machine has
    if (std::strcmp(set, "auto") == 0)
        return true;
    const std::int64_t machine = hwy::SupportedTargets() | HWY_SCALAR;
    std::int64_t allowed = 0;
    for (std::size_t k = 0; k < std::size(names); ++k) {
        allowed |= targets[k];
        if (std::strcmp(set, names[k]) == 0 && (machine & telling[k])) {
            allow(machine & allowed);
            return true;
        }
    }
    return false;
}

}  // namespace parallux
