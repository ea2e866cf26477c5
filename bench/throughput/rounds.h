#pragma once

#include <memory>
#include <string>
#include <vector>

#include "throughput/engine.h"

namespace parallux::throughput {

/// All repetitions of one engine on one scene with so many threads.
struct Row {
    std::string scene, engine, choice;
    unsigned threads = 1;
    std::size_t patches = 0;
    double lines_per_bundle = 0;
    std::uint64_t bundles = 0;      ///< of the solve
    std::uint64_t lines = 0;        ///< of one repetition
    std::vector<double> rates;      ///< lines a second, one a repetition
    std::vector<double> hit_rates;  ///< hits a second
    std::vector<double> serial;     ///< share of the time that more threads would not shorten
    double bytes_per_patch = 0;     ///< at the peak, of patches and sides; 0: not measured

    double rate() const;
    double hit_rate() const;
    double spread() const;  ///< highest less lowest, over the median
};

double median(std::vector<double> values);

/// Runs the engines in turn, `repetitions` times over, so that a change of the machine's speed
/// meets all alike. One row for each engine and number of threads, engines of one number together.
std::vector<Row> run_rounds(const Case& of, const std::vector<std::unique_ptr<Engine>>& engines,
                            const std::vector<unsigned>& threads, int repetitions);

}  // namespace parallux::throughput
