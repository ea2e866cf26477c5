#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "parallux/transfer.h"
#include "throughput/cases.h"

namespace parallux::throughput {

/// One timed run of an engine.
struct Measured {
    double seconds = 0;  ///< from the bundle (or its lines) to the merged deltas
    LineCounts counts;
    std::vector<std::uint64_t> exits;  ///< lines that left each patch
    double serial = 0;  ///< of the seconds, those that more threads would not shorten

    double lines_per_second() const { return static_cast<double>(counts.lines) / seconds; }
};

/// A way to find all crossings of many lines and to carry energy along them.
class Engine {
public:
    virtual ~Engine() = default;
    virtual const char* name() const = 0;
    virtual Measured run(unsigned threads) = 0;
    /// What was found to be fastest, where there was a choice.
    virtual std::string choice() const { return ""; }
};

/// solve() by bundles, timed as Seconds::global: its set-up is within.
class BundleEngine : public Engine {
public:
    explicit BundleEngine(const Case& of) : case_(of) {}
    const char* name() const override { return "bundle"; }
    Measured run(unsigned threads) override;

private:
    const Case& case_;
};

/// The names of the engines, bundles first. "bundle-apart" runs with two threads and more only.
const std::vector<std::string>& engine_names();

/// One engine by its name. References keep a reference to the case. `whole`: let them do all of its
/// lines and not only as many as take a good third of a second.
std::unique_ptr<Engine> make_engine(const std::string& name, const Case& of, bool whole);

}  // namespace parallux::throughput
