#pragma once

#include <vector>

#include "efficiency/reference.h"
#include "efficiency/rounds.h"

namespace parallux::efficiency {

/// Whether the reference's runs agree and every method's mean, at its longest, is where
/// the reference is; says what it found.
bool methods_agree(const Reference& reference, const std::vector<Row>& rows);

}  // namespace parallux::efficiency
