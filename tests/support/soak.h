#pragma once

#include <cstdint>
#include <cstdlib>

namespace parallux::test {

/// Which of many choices at random a test makes: fixed under ctest, another in each round of
/// scripts/soak.sh.
inline std::uint64_t soak_round() {
    const char* round = std::getenv("PARALLUX_SOAK");
    return round ? std::strtoull(round, nullptr, 10) : 0;
}

}  // namespace parallux::test
