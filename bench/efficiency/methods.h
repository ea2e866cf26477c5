#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "efficiency/cases.h"
#include "parallux/solve.h"

namespace parallux::efficiency {

/// A way to solve a case, of any length.
struct Contender {
    std::string name;
    SolveSettings settings;  ///< all but length and seed

    /// The settings of a run: so many bundles, or lines where the method has no bundles.
    SolveSettings run(std::uint64_t length, std::uint64_t seed) const;
    bool by_bundles() const { return settings.method == Method::bundles; }
    std::uint64_t least_length() const { return by_bundles() ? 32 : 4096; }
};

/// The paper's bidirectional algorithm: independent lines one after the other, no first shot.
inline const char* const baseline = "paper";
/// The program as it is where nothing is asked for.
inline const char* const default_method = "bundles";

/// All that a case lets run, the baseline first. It has one thread, whatever the others have; says
/// what is left out and why. With names, those alone beside the baseline; a name that none has is
/// Fault::usage.
std::vector<Contender> contenders(const Case& of, unsigned threads,
                                  const std::vector<std::string>& names = {});

}  // namespace parallux::efficiency
