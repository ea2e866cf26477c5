#include <cmath>

#include "error_bars/parts.h"
#include "error_bars/reference.h"
#include "error_bars/tally.h"

namespace parallux::error_bars {

Outcome target(const Options& options) {
    const double wanted = options.tiny ? 0.02 : 0.01;
    Outcome outcome;
    outcome.json = Json::array();
    for (const std::string& name : options.chosen(interval_places(options.tiny))) {
        const Place place = make_place(name, options.tiny);
        SolveSettings settings = options.settings;
        settings.target_error = wanted;
        const std::vector<Solution> runs =
            solve_seeds(place, settings, options.seeds_or(100, 12), 5001, options.threads);
        double bundles = 0;
        for (const Solution& run : runs)
            bundles += static_cast<double>(run.bundles) / static_cast<double>(runs.size());
        const double longer = options.tiny ? 16 : std::min(options.times, 64.0);
        const Reference reference = make_reference(
            place, options.settings, static_cast<std::uint64_t>(longer * bundles), options.threads);

        const Tally tally(place, reference, runs);
        const auto count = static_cast<double>(runs.size());
        double within = 0, overshoot = 0, rounds = 0, most_rounds = 0;
        for (const Solution& run : runs) {
            const double error = relative_rms(place, reference, run.radiosity);
            within += error <= wanted;
            overshoot += wanted / error / count;
            rounds += run.groups / 8.0 / count;
            most_rounds = std::max(most_rounds, run.groups / 8.0);
        }
        // Of a hundred runs five may miss; of few, one.
        const bool good = within >= count - std::max(1.0, std::floor(0.05 * count));
        std::printf(
            "target %s: %.0f of %.0f runs within %.2f %%, target / actual %.2f in the mean, "
            "rounds %.2f (most %.0f), bundles %.0f, intervals covered %.2f %%: %s\n",
            name.c_str(), within, count, 100 * wanted, overshoot, rounds, most_rounds, bundles,
            100 * tally.covered, good ? "good" : "MISSED");
        std::fflush(stdout);
        outcome.json.push_back({{"scene", name},
                                {"runs", runs.size()},
                                {"target", wanted},
                                {"within", within},
                                {"overshoot", overshoot},
                                {"rounds", rounds},
                                {"most_rounds", most_rounds},
                                {"bundles", bundles},
                                {"covered", tally.covered},
                                {"good", good}});
        outcome.good = outcome.good && good;
    }
    return outcome;
}

}  // namespace parallux::error_bars
