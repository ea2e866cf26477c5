#include <algorithm>
#include <cmath>
#include <map>

#include "error_bars/fit.h"
#include "error_bars/parts.h"
#include "error_bars/reference.h"
#include "reference/exact_factors.h"

namespace parallux::error_bars {

namespace {

struct Variant {
    const char* name;
    FirstShot first_shot;
    DirectionSet directions;
};

constexpr Variant variants[] = {{"lattice", FirstShot::exact, DirectionSet::lattice},
                                {"lattice-unshot", FirstShot::off, DirectionSet::lattice},
                                {"random", FirstShot::exact, DirectionSet::random},
                                {"random-unshot", FirstShot::off, DirectionSet::random}};

double quadratic_error(const Patches& patches, const std::function<double(std::size_t)>& error) {
    double sum = 0, area = 0;
    for (std::size_t k = 0; k < patches.reflectance.size(); ++k) {
        sum += patches.area[k / patches.bands] * std::pow(error(k), 2);
        area += patches.area[k / patches.bands];
    }
    return sum / area;
}

// In closed form for the room of scene 1, where nothing stands between any two patches.
Reference reference_of(const Place& place, SolveSettings settings, std::uint64_t bundles,
                       unsigned threads) {
    if (place.name != "paper-600") {
        settings.first_shot = FirstShot::exact;
        return make_reference(place, settings, bundles, threads);
    }
    const Eigen::VectorXd exact =
        exact_radiosity(exact_factors(place.scene, place.patches), place.patches);
    Reference reference;
    reference.radiosity.assign(exact.data(), exact.data() + exact.size());
    reference.error.assign(reference.radiosity.size(), 0);
    reference.bound_z = 1;
    return reference;
}

Point measure(const Place& place, const Reference& reference, const SolveSettings& settings,
              int seeds, unsigned threads) {
    const std::vector<Solution> runs = solve_seeds(place, settings, seeds, 1, threads);
    Point point;
    point.bundles = settings.bundles;
    point.groups = runs.front().groups;
    double squares = 0;
    for (const Solution& run : runs) {
        const double error = quadratic_error(place.patches, [&](std::size_t k) {
            return run.radiosity[k] - reference.radiosity[k];
        });
        point.lines += static_cast<double>(run.counts.lines) / seeds;
        point.error += error / seeds;
        squares += error * error / seeds;
    }
    point.spread = std::sqrt(std::max(0.0, squares / std::pow(point.error, 2) - 1) / (seeds - 1));
    return point;
}

bool judge(const Variant& variant, const Fit& fit, const std::vector<Point>& points, bool tiny) {
    if (variant.directions == DirectionSet::random)
        return std::fabs(fit.slope + 1) < 0.15 + 2 * tiny * fit.error;
    // Two standard errors, and for neighbours, of which there are many, three.
    bool good = fit.slope < -1.25 + 2 * fit.error;
    for (std::size_t k = 1; k < points.size(); ++k) {
        const Fit local = fit_between(points[k - 1], points[k]);
        good = good && local.slope < -1 + 3 * local.error;
    }
    return good;
}

void report(const Place& place, const Variant& variant, const std::vector<Point>& points,
            double own, bool tiny, Outcome& outcome) {
    const Fit fit = fit_line(points);
    const bool good = judge(variant, fit, points, tiny) && own < points.back().error / 10;
    std::printf("slope %s %s: %.3f ± %.3f: %s (reference's own error / the least: %.4f)\n",
                place.name.c_str(), variant.name, fit.slope, fit.error, good ? "good" : "MISSED",
                own / points.back().error);
    Json rows = Json::array();
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Point& point = points[k];
        const Fit local = k ? fit_between(points[k - 1], point) : Fit{};
        std::printf("    %6llu bundles, %2u groups, %10.4g lines: %.4g ± %4.1f %%",
                    static_cast<unsigned long long>(point.bundles), point.groups, point.lines,
                    point.error, 100 * point.spread);
        if (k)
            std::printf("   local %.2f ± %.2f", local.slope, local.error);
        std::printf("\n");
        rows.push_back({{"bundles", point.bundles},
                        {"groups", point.groups},
                        {"lines", point.lines},
                        {"quadratic_error", point.error},
                        {"relative_spread", point.spread},
                        {"local_slope", k ? Json(local.slope) : Json()}});
    }
    std::fflush(stdout);
    outcome.json.push_back({{"scene", place.name},
                            {"variant", variant.name},
                            {"slope", fit.slope},
                            {"standard_error", fit.error},
                            {"reference_over_least", own / points.back().error},
                            {"points", rows},
                            {"good", good}});
    outcome.good = outcome.good && good;
}

}  // namespace

Outcome slope(const Options& options) {
    Outcome outcome;
    outcome.json = Json::array();
    // Two decades of runs that state their error.
    const std::uint64_t shortest = options.tiny ? 64 : 800, longest = options.tiny ? 512 : 102400;
    for (const std::string& name : options.chosen(slope_places(options.tiny))) {
        const Place place = make_place(name, options.tiny);
        const Reference reference =
            reference_of(place, SolveSettings{}, 8 * longest, options.threads);
        const double own =
            quadratic_error(place.patches, [&](std::size_t k) { return reference.error[k]; });
        if (!reference.agree()) {
            std::printf("slope %s: references differ by %.2f deviations: MISSED\n", name.c_str(),
                        reference.worst_z);
            outcome.good = false;
        }
        for (const Variant& variant : variants) {
            if (!options.variants.empty() &&
                std::find(options.variants.begin(), options.variants.end(), variant.name) ==
                    options.variants.end())
                continue;
            SolveSettings settings = options.settings;
            settings.first_shot = variant.first_shot;
            settings.directions = variant.directions;
            std::vector<Point> points;
            for (settings.bundles = shortest; settings.bundles <= longest; settings.bundles *= 2) {
                settings.lines_per_patch =
                    options.settings.lines_per_patch *
                    std::pow(static_cast<double>(settings.bundles) / 1024, options.growth);
                points.push_back(
                    measure(place, reference, settings, options.seeds_or(16, 8), options.threads));
            }
            report(place, variant, points, own, options.tiny, outcome);
        }
    }
    return outcome;
}

}  // namespace parallux::error_bars
