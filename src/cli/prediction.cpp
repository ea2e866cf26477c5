#include "cli/prediction.h"

#include <cstdio>

#include "parallux/predict.h"

namespace parallux {

using Json = nlohmann::ordered_json;

Json predict_lines(const Scene& scene, const InfoOptions& options) {
    const Patches patches = make_patches(scene, options.patches);
    const double lines = static_cast<double>(options.solve.lines);
    Json result{{"patches", patches.count()},
                {"lines", options.solve.lines},
                {"error", options.error},
                {"forms", Json::array()}};
    for (FirstShot shot : {FirstShot::rays, FirstShot::off})
        for (Direction direction : {Direction::bidirectional, Direction::oriented}) {
            SolveSettings settings = options.solve;
            settings.first_shot = shot;
            settings.direction = direction;
            const Prediction prediction = predict_error(scene, patches, settings);
            const double quadratic = prediction.quadratic(lines);
            result["forms"].push_back(
                {{"direction", direction == Direction::oriented ? "oriented" : "bidirectional"},
                 {"first_shot", shot != FirstShot::off},
                 {"quadratic_error", quadratic},
                 {"relative_rms", prediction.relative(quadratic)},
                 {"lines_for_error", prediction.lines_for(options.error)}});
        }
    return result;
}

std::string prediction_text(const Json& prediction) {
    char line[160];
    auto format = [&](auto... values) {
        std::snprintf(line, sizeof line, values...);
        return std::string(line);
    };
    std::string text =
        format("\n%llu patches, independent lines (--method lines), all bands together\n",
               prediction["patches"].get<unsigned long long>());
    text += format("%-30s %22s %14s %16s\n", "", "quadratic error of", "relative RMS", "lines for");
    text += format("%-30s %16.4g lines %14s %14.3g %%\n", "", prediction["lines"].get<double>(), "",
                   100 * prediction["error"].get<double>());
    for (const Json& form : prediction["forms"]) {
        const std::string name = form["direction"].get<std::string>() +
                                 (form["first_shot"].get<bool>() ? ", first shot" : "");
        text += format(
            "%-30s %22.4g %12.3g %% %16.4g\n", name.c_str(), form["quadratic_error"].get<double>(),
            100 * form["relative_rms"].get<double>(), form["lines_for_error"].get<double>());
    }
    return text + "Bundles of shuffled lattice directions do several times better.\n";
}

}  // namespace parallux
