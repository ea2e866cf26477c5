#include "error_bars/tally.h"

#include <algorithm>
#include <cmath>

namespace parallux::error_bars {

namespace {

Tally::Value tally_value(std::size_t k, double truth, const std::vector<Solution>& runs) {
    Tally::Value value;
    const double share = 1 / static_cast<double>(runs.size());
    value.radiosity = truth;
    for (const Solution& run : runs) {
        const double error = run.radiosity[k] - truth, deviation = run.stderror[k];
        value.covered += share * (std::fabs(error) <= t_bound(run.groups - 1) * deviation);
        value.mean += share * error;
        value.stated += share * deviation * deviation;
    }
    double fourth = 0;
    for (const Solution& run : runs) {
        const double square = std::pow(run.radiosity[k] - truth - value.mean, 2);
        value.variance += square / (static_cast<double>(runs.size()) - 1);
        fourth += share * square * square;
    }
    value.kurtosis = fourth / std::pow(value.variance, 2) - 3;
    value.counts = value.variance > 0;
    return value;
}

}  // namespace

Tally::Tally(const Place& place, const Reference& reference, const std::vector<Solution>& all)
    : values(reference.radiosity.size()), runs(all.size()) {
    double count = 0, own = 0, said = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!reflects(place.patches, k))
            continue;
        Value& value = values[k] = tally_value(k, reference.radiosity[k], all);
        value.exits = static_cast<double>(all.front().crossings[k / place.patches.bands]);
        if (!value.counts)
            continue;
        ++count;
        covered += value.covered;
        own += std::pow(reference.error[k], 2);
        said += value.stated;
        worst_reference_ratio =
            std::max(worst_reference_ratio, reference.error[k] / std::sqrt(value.stated));
    }
    covered /= count;
    reference_ratio = std::sqrt(own / said);
    const double share = 1 / static_cast<double>(runs);
    for (const Solution& run : all) {
        const double error = relative_rms(place, reference, run.radiosity);
        bounded += share * (error <= run.relative_rms_bound);
        actual += share * error * error;
        stated += share * run.relative_rms * run.relative_rms;
    }
    actual = std::sqrt(actual);
    stated = std::sqrt(stated);
}

Json quarters(const Tally& tally, const char* name, double Tally::Value::*property, bool print) {
    std::vector<const Tally::Value*> order;
    for (const Tally::Value& value : tally.values)
        if (value.counts)
            order.push_back(&value);
    std::sort(order.begin(), order.end(),
              [&](auto* a, auto* b) { return a->*property < b->*property; });
    Json rows = Json::array();
    for (std::size_t part = 0; part < 4; ++part) {
        const std::size_t from = part * order.size() / 4, to = (part + 1) * order.size() / 4;
        double covered = 0, variance = 0, bias = 0, count = static_cast<double>(to - from);
        for (std::size_t k = from; k < to; ++k) {
            covered += order[k]->covered / count;
            variance += order[k]->variance / order[k]->stated / count;
            // What of the mean's square is not the noise of the mean.
            bias += (std::pow(order[k]->mean, 2) / order[k]->variance -
                     1 / static_cast<double>(tally.runs)) /
                    count;
        }
        const double low = order[from]->*property, high = order[to - 1]->*property;
        if (print)
            std::printf(
                "    %-9s %9.3g … %-9.3g covered %5.2f %%  variance / stated %.3f  "
                "bias² / variance %+.4f\n",
                name, low, high, 100 * covered, variance, bias);
        rows.push_back({{"by", name},
                        {"from", low},
                        {"to", high},
                        {"covered", covered},
                        {"variance_over_stated", variance},
                        {"bias_squared_over_variance", bias}});
    }
    return rows;
}

void print_where(const Tally& tally) {
    std::vector<std::size_t> order;
    double outside = 0;
    for (std::size_t k = 0; k < tally.values.size(); ++k)
        if (tally.values[k].counts) {
            order.push_back(k);
            outside += tally.values[k].covered < 0.935 || tally.values[k].covered > 0.965;
        }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return tally.values[a].covered < tally.values[b].covered;
    });
    std::printf("    values outside 93.5 … 96.5 %%: %.1f %%; worst:\n",
                100 * outside / static_cast<double>(order.size()));
    for (std::size_t k = 0; k < std::min<std::size_t>(order.size(), 5); ++k) {
        const Tally::Value& value = tally.values[order[k]];
        std::printf(
            "    value %5zu  covered %5.2f %%  variance / stated %.3f  bias / deviation "
            "%+.3f  kurtosis %+.2f  exits %.0f  B %.3g\n",
            order[k], 100 * value.covered, value.variance / value.stated,
            value.mean / std::sqrt(value.variance), value.kurtosis, value.exits, value.radiosity);
    }
}

}  // namespace parallux::error_bars
