#pragma once

#include "efficiency/reference.h"

namespace parallux::efficiency {

/// Reads the reference that write_reference() left for the same case, settings and version. False
/// where there is none or it does not fit, which is said.
bool read_reference(const Case& of, const ReferenceSettings& settings, Reference& reference);

/// Leaves it as CASE-KEY.json in the folder, which is made where it is missing. Throws
/// Fault::output.
void write_reference(const Case& of, const ReferenceSettings& settings, const Reference& reference);

}  // namespace parallux::efficiency
