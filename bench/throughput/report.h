#pragma once

#include <string>
#include <vector>

#include "throughput/rounds.h"

namespace parallux::throughput {

/// The rows of one scene, and how bundles stand to the others.
void print_rows(const std::vector<Row>& rows);

/// Writes {"rows": […]}; the file is whole or untouched.
void write_json(const std::string& file, const std::vector<Row>& rows);

}  // namespace parallux::throughput
