#include <cmath>

#include "error_bars/parts.h"
#include "error_bars/tally.h"

namespace parallux::error_bars {

namespace {

// Shares of so many runs that are as good as 95 %: two standard deviations of the binomial.
double least_share(std::size_t runs) {
    return 0.95 - 2 * std::sqrt(0.95 * 0.05 / static_cast<double>(runs));
}

bool judge(const Tally& tally, const Reference& reference, bool tiny) {
    // Few seeds leave the share of the intervals itself uncertain: values of a run err together.
    const double slack = tiny ? 0.015 : 0;
    return tally.covered >= 0.935 - slack && tally.covered <= 0.965 + slack &&
           tally.bounded >= least_share(tally.runs) && reference.agree() &&
           (tiny || tally.reference_ratio < 1.0 / 15);
}

Json row_of(const Place& place, const Tally& tally, const Reference& reference, bool good) {
    Json row{{"scene", place.name},
             {"patches", place.patches.count()},
             {"bands", place.patches.bands},
             {"runs", tally.runs},
             {"covered", tally.covered},
             {"bounded", tally.bounded},
             {"actual_rms", tally.actual},
             {"stated_rms", tally.stated},
             {"reference_over_stated", tally.reference_ratio},
             {"worst_reference_over_stated", tally.worst_reference_ratio},
             {"references_rms_z", reference.rms_z},
             {"references_worst_z", reference.worst_z},
             {"references_bound_z", reference.bound_z},
             {"good", good}};
    row["where"] = Json::array();
    for (auto [name, property] :
         {std::pair{"exits", &Tally::Value::exits}, std::pair{"B", &Tally::Value::radiosity},
          std::pair{"kurtosis", &Tally::Value::kurtosis}})
        for (Json& quarter : quarters(tally, name, property, true))
            row["where"].push_back(std::move(quarter));
    return row;
}

}  // namespace

Outcome coverage(const Options& options) {
    Outcome outcome;
    outcome.json = Json::array();
    for (const std::string& name : options.chosen(interval_places(options.tiny))) {
        // Solve it over and over, and twice far longer.
        const Place place = make_place(name, options.tiny);
        SolveSettings settings = options.settings;
        settings.bundles = options.bundles_or(options.tiny ? 1024 : 2048);
        settings.groups = 8;
        const double longer = options.tiny ? 16 : options.times;
        const Reference reference = make_reference(
            place, settings,
            static_cast<std::uint64_t>(longer * static_cast<double>(settings.bundles)),
            options.threads);
        const std::vector<Solution> runs =
            solve_seeds(place, settings, options.seeds_or(2000, 24), 1, options.threads);

        // Count how often the intervals and the bounds hold.
        const Tally tally(place, reference, runs);
        const bool good = judge(tally, reference, options.tiny);
        std::printf("coverage %s: %zu patches, %u bands, %zu runs of %llu bundles\n", name.c_str(),
                    place.patches.count(), place.patches.bands, runs.size(),
                    static_cast<unsigned long long>(settings.bundles));
        std::printf(
            "    references %.0f times longer: differ by rms z %.3f, worst %.2f of %.2f; "
            "error / stated %.4f, worst value %.4f\n",
            longer, reference.rms_z, reference.worst_z, reference.bound_z, tally.reference_ratio,
            tally.worst_reference_ratio);
        std::printf(
            "    covered %.2f %%, runs below their bound %.2f %%, rms actual %.4f %% stated "
            "%.4f %%: %s\n",
            100 * tally.covered, 100 * tally.bounded, 100 * tally.actual, 100 * tally.stated,
            good ? "good" : "MISSED");
        outcome.json.push_back(row_of(place, tally, reference, good));
        print_where(tally);
        std::fflush(stdout);
        outcome.good = outcome.good && good;
    }
    return outcome;
}

}  // namespace parallux::error_bars
