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
    std::vector<double> errors;  ///< of the runs, against what the table is judged by
    Spread ours;                 ///< of those
    Spread to_truth;             ///< against the exact solution (scene 2: long runs of bundles)
    Spread to_counts;            ///< against [Sbert93] on the same lines, where judged_by_counts()
    double predicted = 0;
    std::vector<Spread> bundles;  ///< as bundle_variants() has them

    double ratio() const { return ours.mean / cell.paper; }
    double z() const { return z_of(ours); }
    /// (spread's mean - paper) over the combined standard error: that of our runs, of the paper's
    /// 100 with the same spread, and of its last digit.
    double z_of(const Spread& spread) const;
};

/// Least squares of log error, weighted by the spread of the runs. Against lines: one slope for all
/// numbers of patches of a scene and variant, each with a level of its own; against patches: one
/// for all numbers of lines. The law is of many exits and many patches: cells with fewer than 20
/// expected exits a patch are left out of both, and 6 patches out of the second, where Σ F_ij² is
/// no longer small against 1.
struct Slope {
    std::string scene, variant, against;
    double slope = 0, error = 0;
    int cells = 0;
};
std::vector<Slope> slopes_of(Rooms& rooms, const std::vector<Result>& results);

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
