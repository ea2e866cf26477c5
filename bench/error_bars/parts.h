#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "parallux/solve.h"

namespace parallux::error_bars {

using Json = nlohmann::ordered_json;

/// What the command line says; 0: as the part has it.
struct Options {
    int seeds = 0;
    unsigned threads = 0;
    bool tiny = false;
    std::vector<std::string> scenes;  ///< empty: the part's own
    std::uint64_t bundles = 0;        ///< of a run of coverage
    double times = 256;               ///< how much longer each of the two references is
    SolveSettings settings;           ///< of every run, but for its length
    double growth = 0;  ///< of slope: lines a patch go as bundles to this power, as set at 1024
    std::vector<std::string> variants;  ///< of slope; empty: all

    std::vector<std::string> chosen(const std::vector<std::string>& usual) const {
        return scenes.empty() ? usual : scenes;
    }
    std::uint64_t bundles_or(std::uint64_t usual) const { return bundles ? bundles : usual; }
    int seeds_or(int usual, int few) const { return seeds ? seeds : tiny ? few : usual; }
};

/// Each prints its table, returns whether all bounds hold and what was measured.
struct Outcome {
    bool good = true;
    Json json;
};

/// Shares of intervals of 95 % that hold the reference, and of runs below their stated bound.
Outcome coverage(const Options& options);
/// Runs to a stated error: how many are within it, and how far.
Outcome target(const Options& options);
/// Means of stopped runs against the reference.
Outcome bias(const Options& options);
/// How the quadratic error falls with the lines.
Outcome slope(const Options& options);

}  // namespace parallux::error_bars
