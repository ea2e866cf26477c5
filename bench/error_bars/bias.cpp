#include <cmath>
#include <cstring>

#include "error_bars/parts.h"
#include "error_bars/reference.h"
#include "support/statistics.h"

namespace parallux::error_bars {

namespace {

struct Verdict {
    double rms_z = 0;       // of all values
    double least_tail = 1;  // smallest two-sided probability of a value
    double level = 0;       // Šidák: what none should be below
    double mean_z = 0;      // of the mean over all values, by area
    double rms_bias = 0;    // what the values' means are off beyond noise, over a run's deviation
    double mean_bias = 0;   // of the mean over all values, relative

    double bound_z = 3.3;  // of mean_z: one in a thousand

    bool good() const { return least_tail > level && std::fabs(mean_z) < bound_z; }
};

double area_mean(const Patches& patches, const std::function<double(std::size_t)>& value) {
    double sum = 0, area = 0;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        sum += patches.area[k / patches.bands] * value(k);
        area += patches.area[k / patches.bands];
    }
    return sum / area;
}

// Two independent estimates of one value, each with its own error (Welch and Satterthwaite).
double tail(double difference, double a, double freedom_a, double b, double freedom_b) {
    const double square = a * a + b * b;
    const double freedom =
        square * square / (std::pow(a, 4) / freedom_a + std::pow(b, 4) / freedom_b);
    return test::student_tail(difference / std::sqrt(square), static_cast<int>(freedom));
}

Verdict judge(const Place& place, const Reference& reference, const std::vector<Solution>& runs,
              double bound_z) {
    Verdict verdict;
    verdict.bound_z = bound_z;
    std::vector<test::Sample> samples(reference.radiosity.size());
    test::Sample means;
    for (const Solution& run : runs) {
        for (std::size_t k = 0; k < samples.size(); ++k)
            samples[k].add(run.radiosity[k]);
        means.add(area_mean(place.patches, [&](std::size_t k) { return run.radiosity[k]; }));
    }
    double count = 0, own = 0, spread = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        if (!reflects(place.patches, k) || samples[k].variance() == 0)
            continue;
        const double difference = samples[k].mean() - reference.radiosity[k];
        const double error = samples[k].standard_error();
        verdict.least_tail = std::min(
            verdict.least_tail,
            tail(difference, error, samples[k].count - 1, reference.error[k], reference_freedom));
        const double noise = error * error + std::pow(reference.error[k], 2);
        verdict.rms_z += difference * difference / noise;
        verdict.rms_bias += (difference * difference - noise) / samples[k].variance();
        own += std::pow(reference.error[k], 2);
        spread += samples[k].variance();
        ++count;
    }
    verdict.rms_z = std::sqrt(verdict.rms_z / count);
    verdict.rms_bias =
        std::copysign(std::sqrt(std::fabs(verdict.rms_bias) / count), verdict.rms_bias);
    verdict.level = 1 - std::pow(1 - 1e-3, 1 / count);
    // The reference's mean is taken to be better than a run's by as much as its values are.
    const double truth =
        area_mean(place.patches, [&](std::size_t k) { return reference.radiosity[k]; });
    const double noise = means.variance() * (1.0 / means.count + own / spread);
    verdict.mean_z = (means.mean() - truth) / std::sqrt(noise);
    verdict.mean_bias = means.mean() / truth - 1;
    return verdict;
}

void report(const Place& place, const char* kind, const std::vector<Solution>& runs,
            const Verdict& verdict, Outcome& outcome) {
    double groups = 0;
    for (const Solution& run : runs)
        groups += run.groups / static_cast<double>(runs.size());
    std::printf(
        "bias %s, %s: %zu runs of %.1f groups; values: rms z %.3f, least tail %.2g (Šidák "
        "%.2g), bias beyond noise %+.3f deviations; mean: z %+.2f, %+.4f %%: %s\n",
        place.name.c_str(), kind, runs.size(), groups, verdict.rms_z, verdict.least_tail,
        verdict.level, verdict.rms_bias, verdict.mean_z, 100 * verdict.mean_bias,
        verdict.good() ? "good" : "MISSED");
    std::fflush(stdout);
    outcome.json.push_back({{"scene", place.name},
                            {"kind", kind},
                            {"runs", runs.size()},
                            {"groups", groups},
                            {"rms_z", verdict.rms_z},
                            {"least_tail", verdict.least_tail},
                            {"sidak_level", verdict.level},
                            {"bias_in_deviations", verdict.rms_bias},
                            {"mean_z", verdict.mean_z},
                            {"mean_relative", verdict.mean_bias},
                            {"good", verdict.good()}});
    outcome.good = outcome.good && verdict.good();
}

}  // namespace

Outcome bias(const Options& options) {
    Outcome outcome;
    outcome.json = Json::array();
    const double bound_z = options.tiny ? 6 : 3.3;  // a few runs tell their own spread but roughly
    const int seeds = options.seeds_or(256, 16);
    for (const std::string& name : options.chosen(interval_places(options.tiny))) {
        const Place place = make_place(name, options.tiny);
        SolveSettings settings = options.settings;
        settings.bundles = options.bundles_or(options.tiny ? 1024 : 2048);
        settings.groups = 8;
        const double longer = options.tiny ? 16 : options.times;
        const Reference reference = make_reference(
            place, settings,
            static_cast<std::uint64_t>(longer * static_cast<double>(settings.bundles)),
            options.threads);

        // Stopped by the callback within the fourth group of eight, which is left out.
        const std::vector<Solution> stopped = solve_seeds(
            place, settings, seeds, 20'001, options.threads, [](const Progress& progress) {
                return std::strcmp(progress.stage, "bundles") != 0 || progress.done < 0.45;
            });
        report(place, "stopped by callback", stopped, judge(place, reference, stopped, bound_z),
               outcome);

        // Stopped by their own error.
        settings.target_error = options.tiny ? 0.02 : 0.01;
        settings.bundles = 0;
        settings.groups = options.settings.groups;
        const std::vector<Solution> reached =
            solve_seeds(place, settings, seeds, 30'001, options.threads);
        report(place, "to a stated error", reached, judge(place, reference, reached, bound_z),
               outcome);
    }
    return outcome;
}

}  // namespace parallux::error_bars
