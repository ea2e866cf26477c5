#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallux/solve.h"

// The tables of M. Sbert and X. Pueyo, A Global Algorithm for Linear Radiosity (LSI-93-37-R, 1993),
// cell by cell as printed.

namespace parallux::paper {

/// One form of the algorithm.
struct Variant {
    const char* name;
    Method method = Method::lines;
    Direction direction = Direction::bidirectional;
    FirstShot first_shot = FirstShot::off;
    DirectionSet directions = DirectionSet::lattice;
    double lines_per_patch = 1;  ///< of bundles
};

/// One printed number.
struct Cell {
    int table;
    const char* scene;  ///< file in scenes/, without its ending
    std::uint32_t patches;
    std::uint64_t lines;
    Variant variant;        ///< as the paper's
    double paper;           ///< quadratic error as printed; 0: a cell that the paper leaves out
    bool doubtful = false;  ///< does not agree with the paper's own other tables
};

/// All cells, in the paper's order; tables 4 and 6 have 600 patches too, to show the slope.
std::vector<Cell> all_cells();

/// Tables 1 and 2 are measured "respective to the solution found with the method of [Sbert93]".
/// That of very many lines is the exact one; that of the same lines shares their errors. Table 1
/// agrees with the first and table 2 with the second, so that both are measured for both.
inline bool judged_by_counts(int table) {
    return table <= 2;
}

/// What a table's caption says.
const char* caption(int table);

/// The columns beside the paper's: bundles with the first shot of the cell's variant.
std::vector<Variant> bundle_variants(const Variant& paper);

}  // namespace parallux::paper
