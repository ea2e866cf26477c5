#include "paper/distribution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include <unsupported/Eigen/SpecialFunctions>

#include "output/output_file.h"

namespace parallux::paper {

double scaled_chi_square(double x, double mean, double freedom) {
    return x > 0 ? Eigen::numext::igamma(freedom / 2, x / mean * freedom / 2) : 0;
}

double kolmogorov_smirnov(std::vector<double> values, double mean, double freedom) {
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    double distance = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double expected = scaled_chi_square(values[k], mean, freedom);
        distance = std::max({distance, expected - static_cast<double>(k) / n,
                             static_cast<double>(k + 1) / n - expected});
    }
    const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
    double p = 0;
    for (int k = 1; k <= 100; ++k)
        p += (k % 2 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
    return lambda < 0.2 ? 1 : std::clamp(p, 0.0, 1.0);
}

void write_histograms(const std::string& folder, const std::vector<Distribution>& distributions) {
    for (const Distribution& d : distributions) {
        // Bins of a quarter of the standard deviation, up to four of them beyond the mean.
        const double width = d.mean * d.variation / 4;
        const int bins = static_cast<int>(std::ceil((d.mean * (1 + 4 * d.variation)) / width));
        std::vector<int> counts(static_cast<std::size_t>(bins), 0);
        for (double error : d.errors)
            ++counts[static_cast<std::size_t>(
                std::clamp(static_cast<int>(error / width), 0, bins - 1))];
        std::ostringstream text;
        text.imbue(std::locale::classic());
        text << "# error  runs  runs expected of the fitted chi-square  of the theory's\n";
        const double runs = static_cast<double>(d.errors.size());
        for (int bin = 0; bin < bins; ++bin) {
            auto expected = [&](double mean, double freedom) {
                return runs * (scaled_chi_square((bin + 1) * width, mean, freedom) -
                               scaled_chi_square(bin * width, mean, freedom));
            };
            text << (bin + 0.5) * width << ' ' << counts[static_cast<std::size_t>(bin)] << ' '
                 << expected(d.mean, d.freedom) << ' ' << expected(d.theory_mean, d.theory_freedom)
                 << '\n';
        }
        OutputFile file(folder + "/figure" + std::to_string(d.figure) + "_" +
                        std::to_string(d.lines) + ".dat");
        file.write(text.str());
        file.commit();
    }
}

}  // namespace parallux::paper
