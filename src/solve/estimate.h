#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solve/direct_light.h"
#include "solve/foresight.h"
#include "solve/pass.h"
#include "solve/run.h"

namespace parallux {

/// The seed of a group of a run; that of the first is the run's own.
std::uint64_t group_seed(std::uint64_t seed, std::uint32_t group);

/// What the groups of a run come to: independent runs, each with its own first shot, pass and
/// gather, whose spread tells the error of their mean. Patch by patch a group weighs as much as
/// lines left the patch in it. Two floats a patch and band, whatever the groups.
class Estimate {
public:
    explicit Estimate(const Patches& patches) : patches_(patches) {}

    /// Takes a group's irradiance, direct and the pass's, its counts and its balance.
    void add(const Run& run, const DirectLight& direct, PassResult& pass);
    std::uint32_t groups() const { return groups_; }
    std::uint64_t bundles() const { return total_.bundles; }
    /// The error as the solution will state it, and what it will be; of less than two groups
    /// nothing is known, and its bound is infinite.
    Foresight foresight() const;
    /// The next group was stopped before its end, and is left out.
    void stop() { total_.partial = true; }

    /// All that it knows, to be written or read; sound() is false for what cannot be.
    template <class Archive>
    void fields(Archive& a) {
        a(groups_), a(irradiance_), a(spread_), a(sketches_), a(total_.crossings);
        fields_of(a, total_.energy);
        fields_of(a, total_.counts);
        a(total_.bundles), a(total_.first_shot_rays), a(total_.shots), a(total_.leaks);
        a(total_.warnings);
    }
    bool sound() const;

    /// The mean of the groups: radiosity B = E + ρ H, and from two groups on the standard error of
    /// every patch and the relative RMS of all that do not emit, with its bound of 95 %. Gives its
    /// memory to the solution.
    Solution solution(const Plan& plan);

private:
    // Random signs times the error of a group, whose products between groups tell how many patches
    // err together.
    static constexpr std::size_t sketch_size = 64;
    struct Sketch {
        double lines;  ///< of the group
        std::array<double, sketch_size> sums;
    };

    void spread_scattered(const std::vector<float>& irradiance,
                          const std::vector<std::uint64_t>& crossings, unsigned threads);
    void sketch(const std::vector<float>& irradiance, double lines, unsigned threads);
    double freedom() const;
    double deviation(std::size_t k) const;
    double relative_rms() const;

    const Patches& patches_;
    std::uint32_t groups_ = 0;
    std::vector<float> irradiance_;  // mean, patch · bands + band
    std::vector<float> spread_;      // Σ weight (irradiance - mean)², or see spread_scattered()
    std::vector<Sketch> sketches_;
    Solution total_;  // counts, crossings, balance
};

}  // namespace parallux
