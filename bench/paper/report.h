#pragma once

#include <string>
#include <vector>

#include "paper/distribution.h"
#include "paper/pictures.h"
#include "paper/runs.h"

// What people and programs read.

namespace parallux::paper {

struct Result {
    Cell cell;
    std::vector<double> errors;  ///< of the runs
    Spread ours;
    double predicted = 0;
    std::vector<Spread> bundles;  ///< as bundle_variants() has them

    double ratio() const { return ours.mean / cell.paper; }
    /// (ours - paper) over the combined standard error: that of our runs, of the paper's 100 with
    /// the same spread, and of its last digit.
    double z() const;
};

/// Least squares of log error against log lines or log patches.
struct Slope {
    std::string variant, scene, against;
    double slope = 0;
    int points = 0;
};
std::vector<Slope> slopes_of(const std::vector<Result>& results);

/// The cells of figures 3 and 4.
std::vector<Distribution> distributions_of(Rooms& rooms, const std::vector<Result>& results);

/// Cells that are more than 3.5 combined standard errors from the paper, the doubtful left out.
int disagreements(const std::vector<Result>& results);

void print_heading(int table);
void print_row(const Result& result);
void print_slopes(const std::vector<Slope>& slopes);
void print_gains(const std::vector<Result>& results);
void print_distributions(const std::vector<Distribution>& distributions);
void print_pictures(const std::vector<PictureRun>& pictures);

void write_json(const std::string& file, const std::vector<Result>& results,
                const std::vector<Slope>& slopes, const std::vector<Distribution>& distributions,
                const std::vector<PictureRun>& pictures);

}  // namespace parallux::paper
