#pragma once

#include <string>
#include <vector>

#include "efficiency/goals.h"
#include "efficiency/rounds.h"

namespace parallux::efficiency {

/// The rows of one case: a line for every method, at its best length.
void print_rows(const std::vector<Row>& rows, int seeds, Clock clock);

void print_goals(const std::vector<Goal>& goals);

/// Writes {"rows": […], "goals": […]}; the file is whole or untouched.
void write_json(const std::string& file, const std::vector<Row>& rows,
                const std::vector<Goal>& goals, Clock clock);

/// Leaves SCENE.dat in the folder for figures.gp: a block for every method, a line for every
/// length with seconds, relative RMS and lines.
void write_curves(const std::string& folder, const std::vector<Row>& rows);

}  // namespace parallux::efficiency
