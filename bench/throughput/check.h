#pragma once

#include "throughput/cases.h"

namespace parallux::throughput {

/// Whether all engines find the same on a case, which should be tiny; says what they found. Needs
/// no exact arithmetic, only that each engine casts the lines it claims to cast.
bool engines_agree(const Case& of);

}  // namespace parallux::throughput
