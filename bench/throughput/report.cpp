#include "throughput/report.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "output/output_file.h"

namespace parallux::throughput {

namespace {

const Row* find(const std::vector<Row>& rows, const Row& like, const std::string& engine,
                unsigned threads) {
    for (const Row& row : rows)
        if (row.scene == like.scene && row.engine == engine && row.threads == threads)
            return &row;
    return nullptr;
}

// Median of the ratios of each repetition, whose two runs met the machine in one state.
double ratio(const Row& a, const Row& b) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < std::min(a.rates.size(), b.rates.size()); ++k)
        ratios.push_back(a.rates[k] / b.rates[k]);
    return median(ratios);
}

// Bundles against (a), and against the fastest of (a), (b) and (c).
struct Ratios {
    double to_lines = 0, to_best = 0;
    std::string best;
};

Ratios ratios_of(const std::vector<Row>& rows, const Row& bundle) {
    const Row* best = nullptr;
    for (const char* engine : {"embree-lines", "embree-lines-parents", "embree-packets"}) {
        const Row* row = find(rows, bundle, engine, bundle.threads);
        if (row && (!best || row->rate() > best->rate()))
            best = row;
    }
    const Row* lines = find(rows, bundle, "embree-lines", bundle.threads);
    return {lines ? ratio(bundle, *lines) : 0, best ? ratio(bundle, *best) : 0,
            best ? best->engine : ""};
}

// What more threads gain over one, and over as many processes of one thread each; and the share of
// one thread's time that does not gain (G. Amdahl, 1967), as the run itself measured it.
struct Scaling {
    double gain = 0, of_apart = 0, serial = 0;

    double gain_of(double cores) const { return 1 / (serial + (1 - serial) / cores); }
};

Scaling scaling_of(const std::vector<Row>& rows, const Row& row) {
    Scaling scaling;
    if (const Row* one = find(rows, row, row.engine, 1)) {
        scaling.serial = median(one->serial);
        if (row.threads > 1)
            scaling.gain = ratio(row, *one);
    }
    if (const Row* apart = find(rows, row, "bundle-apart", row.threads))
        scaling.of_apart = ratio(row, *apart);
    return scaling;
}

void print_scaling(const Row& row, const Scaling& scaling) {
    if (row.threads == 1)
        std::printf("1 thread: %.2f %% serial; on 64 cores this foretells at most %.0f times one\n",
                    100 * scaling.serial, scaling.gain_of(64));
    else if (scaling.gain > 0)
        std::printf("%u threads / 1: %.2f; of %u processes at once: %.2f\n", row.threads,
                    scaling.gain, row.threads, scaling.of_apart);
}

}  // namespace

void print_rows(const std::vector<Row>& rows) {
    std::printf("\n%s: %zu patches, RGB, %.0f lines a bundle, %llu bundles\n",
                rows.front().scene.c_str(), rows.front().patches, rows.front().lines_per_bundle,
                static_cast<unsigned long long>(rows.front().bundles));
    std::printf("%-21s %7s %9s %9s %7s %9s %8s  %s\n", "engine", "threads", "Mlines", "Mlines/s",
                "spread", "Mhits/s", "B/patch", "choice");
    for (const Row& row : rows) {
        std::printf("%-21s %7u %9.2f %9.2f %6.0f%% %9.2f ", row.engine.c_str(), row.threads,
                    static_cast<double>(row.lines) * 1e-6, row.rate() * 1e-6, 100 * row.spread(),
                    row.hit_rate() * 1e-6);
        if (row.bytes_per_patch > 0)
            std::printf("%8.0f", row.bytes_per_patch);
        else
            std::printf("%8s", "");
        std::printf("  %s\n", row.choice.c_str());
    }
    for (const Row& row : rows) {
        if (row.engine != "bundle")
            continue;
        const Ratios ratios = ratios_of(rows, row);
        if (ratios.to_lines > 0)
            std::printf(
                "%u thread%s: bundle / (a) %.1f, bundle / best of (a), (b), (c) %.1f (%s)\n",
                row.threads, row.threads > 1 ? "s" : "", ratios.to_lines, ratios.to_best,
                ratios.best.c_str());
        print_scaling(row, scaling_of(rows, row));
    }
    std::fflush(stdout);
}

void write_json(const std::string& file, const std::vector<Row>& rows) {
    using Json = nlohmann::ordered_json;
    Json json{{"rows", Json::array()}};
    for (const Row& row : rows) {
        Json entry{
            {"scene", row.scene},
            {"engine", row.engine},
            {"threads", row.threads},
            {"patches", row.patches},
            {"lines_per_bundle", row.lines_per_bundle},
            {"lines_per_second", row.rate()},
            {"hits_per_second", row.hit_rate()},
            {"bytes_per_patch", row.bytes_per_patch > 0 ? Json(row.bytes_per_patch) : Json()},
            {"spread", row.spread()},
            {"repetitions", row.rates.size()},
            {"bundles", row.bundles},
            {"lines", row.lines},
            {"choice", row.choice}};
        if (row.engine == "bundle") {
            const Ratios ratios = ratios_of(rows, row);
            const Scaling scaling = scaling_of(rows, row);
            entry["ratio_to_embree_lines"] = ratios.to_lines > 0 ? Json(ratios.to_lines) : Json();
            entry["ratio_to_best"] = ratios.to_best > 0 ? Json(ratios.to_best) : Json();
            entry["best"] = ratios.best;
            entry["gain_of_threads"] = scaling.gain > 0 ? Json(scaling.gain) : Json();
            entry["gain_of_apart"] = scaling.of_apart > 0 ? Json(scaling.of_apart) : Json();
            entry["serial_share"] = median(row.serial);
        }
        json["rows"].push_back(std::move(entry));
    }
    OutputFile output(file);
    output.write(json.dump(2) + "\n");
    output.commit();
}

}  // namespace parallux::throughput
