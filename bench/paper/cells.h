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
    double paper;           ///< quadratic error as printed
    bool doubtful = false;  ///< does not agree with the paper's own other tables
};

/// All cells, in the paper's order.
std::vector<Cell> all_cells();

/// What a table's caption says.
const char* caption(int table);

/// The columns beside the paper's: bundles with the first shot of the cell's variant.
std::vector<Variant> bundle_variants(const Variant& paper);

}  // namespace parallux::paper
