#pragma once

#include <cstdint>
#include <vector>

namespace parallux {

/// Where the power of the sources is once the local shots are over, in quanta; bands of a patch
/// together. emitted = absorbed + escaped + all that is unshot, exactly.
struct DirectLight {
    std::vector<std::int64_t> received;  ///< patch · bands + band
    std::vector<std::int64_t>
        unshot;  ///< reflected, or emitted where no shot took it: for the pass
    std::vector<std::int64_t> emitted, absorbed, escaped;  ///< band totals
    std::uint64_t rays = 0;                                ///< cast
    std::uint64_t shots = 0;                               ///< from single patches
    double done = 1;  ///< share of the sources' rays that was cast
};

}  // namespace parallux
