#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "cli/options.h"

namespace parallux {

/// Expected error of the four forms of the global algorithm, as JSON: patches, lines, error, and
/// forms [{direction, first_shot, quadratic_error, relative_rms, lines_for_error}].
nlohmann::ordered_json predict_lines(const Scene& scene, const InfoOptions& options);

/// The same for people.
std::string prediction_text(const nlohmann::ordered_json& prediction);

}  // namespace parallux
