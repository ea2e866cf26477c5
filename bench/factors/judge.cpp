#include "factors/judge.h"

#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "output/output_file.h"

namespace parallux::factor_bench {

namespace {

// Σ_j (F_ij - F*_ij)² of two sparse rows.
double square_of_row(const Answer& a, const Answer& b, std::size_t i) {
    double sum = 0;
    std::uint64_t k = a.start[i], l = b.start[i];
    const std::uint64_t k_end = a.start[i + 1], l_end = b.start[i + 1];
    while (k < k_end || l < l_end) {
        double difference = 0;
        const std::uint32_t j = k < k_end ? a.column[k] : none;
        const std::uint32_t m = l < l_end ? b.column[l] : none;
        if (j <= m)
            difference += a.factor[k++];
        if (m <= j)
            difference -= b.factor[l++];
        sum += difference * difference;
    }
    return sum;
}

}  // namespace

Row judge(const std::string& scene, const std::string& method, std::uint64_t effort,
          const Patches& patches, const Answer& answer, const Answer& reference) {
    Row row{scene, method, effort, answer.seconds};
    double area = 0, factor = 0, sky = 0, net = 0, all = 0;
    for (std::size_t i = 0; i < patches.count(); ++i) {
        const double own = patches.area[i];
        area += own;
        net += own * std::pow(answer.net[i] - reference.net[i], 2);
        all += own * reference.net[i] * reference.net[i];
        if (answer.sky.empty())
            continue;
        factor += own * square_of_row(answer, reference, i);
        sky += own * std::pow(answer.sky[i] - reference.sky[i], 2);
    }
    row.net_l2 = std::sqrt(net / all);
    if (!answer.sky.empty()) {
        row.rms_factor = std::sqrt(factor / area);
        row.rms_sky = std::sqrt(sky / area);
    }
    return row;
}

void print_heading() {
    std::printf("%-18s %-9s %9s %9s %11s %11s %11s\n", "scene", "method", "effort", "seconds",
                "rms_factor", "rms_sky", "net_l2");
}

void print_row(const Row& row) {
    std::printf("%-18s %-9s %9llu %9.3f %11.3g %11.3g %11.3g\n", row.scene.c_str(),
                row.method.c_str(), static_cast<unsigned long long>(row.effort), row.seconds,
                row.rms_factor, row.rms_sky, row.net_l2);
    std::fflush(stdout);
}

void write_rows(const std::string& file, const std::vector<Row>& rows) {
    nlohmann::ordered_json all;
    all["rows"] = nlohmann::ordered_json::array();
    auto known = [](double value) {
        return value < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
    };
    for (const Row& row : rows)
        all["rows"].push_back({{"scene", row.scene},
                               {"method", row.method},
                               {"effort", row.effort},
                               {"seconds", row.seconds},
                               {"rms_factor", known(row.rms_factor)},
                               {"rms_sky", known(row.rms_sky)},
                               {"net_l2", known(row.net_l2)}});
    OutputFile output(file);
    output.write(all.dump(2) + "\n");
    output.commit();
}

}  // namespace parallux::factor_bench
