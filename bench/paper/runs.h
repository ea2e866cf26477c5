#pragma once

#include <map>
#include <string>
#include <vector>

#include "paper/cells.h"
#include "parallux/parallux.h"

// Many runs of one variant, and how wrong each was.

namespace parallux::paper {

/// A scene with its answer.
struct Room {
    Scene scene;
    Patches patches;
    std::vector<double> truth;    ///< radiosity a patch
    double theory_full = 0;       ///< tr C × lines, bidirectional; convex rooms only, else 0
    double theory_variation = 0;  ///< of a run's error, bidirectional; convex rooms only, else 0
    double theory_freedom = 0;
    std::map<std::string, Prediction> predicted;  ///< by variant
};

/// Quadratic errors Σ A_i (B_i - B_i*)² / Σ A_i of runs with seeds 1 … count, side by side on all
/// cores, each on one.
struct Errors {
    std::vector<double> truth;    ///< B* is the room's
    std::vector<double> counted;  ///< B* is [Sbert93]'s of the very same lines; where asked for
};
Errors run_errors(const Room& room, const Variant& variant, std::uint64_t lines, int count,
                  bool counted);

/// Loads scenes of a folder as they are asked for, and solves each once: convex rooms by exact form
/// factors, scene 2 as the mean of four long runs of bundles with exact first shot.
class Rooms {
public:
    explicit Rooms(std::string folder) : folder_(std::move(folder)) {}

    const Room& room(const std::string& name);
    /// The a-priori error of a variant of lines.
    const Prediction& predicted(const std::string& name, const Variant& variant);
    /// run_errors(), each set of runs once: tables 1 and 3 show the same ones.
    const Errors& errors(const std::string& name, const Variant& variant, std::uint64_t lines,
                         int count, bool counted);

private:
    std::string folder_;
    std::map<std::string, Room> rooms_;
    std::map<std::string, Errors> errors_;
};

struct Spread {
    double mean = 0, deviation = 0;
    int count = 0;
    double standard_error() const;
    /// Standard deviation over mean.
    double variation() const { return deviation / mean; }
};
Spread spread_of(const std::vector<double>& values);

}  // namespace parallux::paper
