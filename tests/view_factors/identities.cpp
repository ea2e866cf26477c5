#include <doctest/doctest.h>

#include <map>

#include "parallux/error.h"
#include "view_factors/scale.h"
#include "view_factors/scenes.h"
#include "view_factors/sparse_rows.h"

// What holds whatever the noise: rows with their outside are 1, exchange is symmetric to the bit,
// and no number of threads changes a byte. Planted, and seen to fail: a row's own factor twice in
// place of both; nothing filled up where scaling cannot close; n_ii counted once.

using namespace parallux;
using namespace parallux::test;

namespace {

// A street: open above, blocks that hide each other, one-sided with inert backs.
Scene street() {
    Scene scene;
    add_plate(scene, {0, 0, 0}, {6, 0, 0}, {0, 4, 0}, "ground");
    scene.surfaces[0].grid_u = 12;
    scene.surfaces[0].grid_v = 8;
    add_turned_cube(scene, {1.5, 1.5, 1.2}, 1, 3, grey(0.3));
    add_turned_cube(scene, {4, 2, 1.4}, 1.2, 3, grey(0.3));
    add_plate(scene, {0, 4, 0}, {6, 0, 0}, {0, 0, 2}, "screen");
    return scene;
}

FactorSettings some_lines() {
    FactorSettings settings;
    settings.bundles = 256;
    return settings;
}

struct Written {
    std::map<std::pair<std::size_t, std::size_t>, double> value;
    std::vector<double> area, outside;
};

// As a user reads them: the symmetric matrix, areas, and the sum of what goes outside.
Written read_back(const Factors& factors) {
    const TemporaryFile matrix("f.mtx"), areas("f.areas.csv"), sky("f.sky.csv");
    write_factors(matrix.path(), factors, FactorValues::exchange);
    write_factor_areas(areas.path(), factors);
    write_sky_factors(sky.path(), factors);
    Written written;
    std::istringstream text(matrix.text());
    std::string line;
    std::getline(text, line);
    CHECK(line == "%%MatrixMarket matrix coordinate real symmetric");
    while (text.peek() == '%')
        std::getline(text, line);
    std::size_t rows, columns, entries, i, j;
    double value;
    text >> rows >> columns >> entries;
    while (text >> i >> j >> value) {
        CHECK(j <= i);
        written.value[{i - 1, j - 1}] = value;
        written.value[{j - 1, i - 1}] = value;
        --entries;
    }
    CHECK(entries == 0);
    auto columns_of = [](const std::string& row) {
        std::vector<std::string> cells;
        std::istringstream cut(row);
        for (std::string cell; std::getline(cut, cell, ',');)
            cells.push_back(cell);
        return cells;
    };
    std::istringstream rows_of_areas(areas.text()), rows_of_sky(sky.text());
    std::getline(rows_of_areas, line);
    while (std::getline(rows_of_areas, line))
        written.area.push_back(std::stod(columns_of(line)[3]));
    std::getline(rows_of_sky, line);
    while (std::getline(rows_of_sky, line)) {
        const std::vector<std::string> cells = columns_of(line);
        written.outside.push_back(std::stod(cells[1]) + std::stod(cells[3]) + std::stod(cells[4]));
    }
    return written;
}

double worst_row(const Written& written) {
    std::vector<double> sum = written.outside;
    for (const auto& [at, value] : written.value)
        sum[at.first] += value / written.area[at.first];
    double worst = 0;
    for (double s : sum)
        worst = std::max(worst, std::fabs(s - 1));
    return worst;
}

}  // namespace

TEST_CASE("written rows close to 1e-12, with and without a threshold") {
    const Scene scene = street();
    const Patches patches = make_patches(scene);
    std::size_t entries = 0;
    for (double threshold : {0.0, 1e-3, 1e-2}) {
        FactorSettings settings = some_lines();
        settings.threshold = threshold;
        const Factors factors = view_factors(scene, patches, settings);
        const FactorCheck check = check_factors(factors);
        CHECK(check.row_deviation < 1e-12);
        CHECK(check.reciprocity == 0);
        CHECK(check.smallest >= 0);
        CHECK(worst_row(read_back(factors)) < 1e-12);
        CHECK(factors.rest == 0);
        CHECK((threshold == 0) == (factors.dropped == 0));
        CHECK((entries == 0 || factors.column.size() < entries));
        entries = factors.column.size();
    }
}

TEST_CASE("counts are whole, symmetric, and come to the exits") {
    // Without scaling nothing hides a line counted on one side only.
    PairCounts counts(3, 3, 2);
    counts.put(0, 2, 1, 5);
    counts.put(1, 1, 2, 2);
    counts.put(1, 0, 0, 3);
    counts.put(0, 2, 3 + 1, 4);
    counts.end_group(2);
    counts.put(0, 0, 3, 1);
    counts.end_group(2);
    CHECK(counts.exits() == std::vector<std::uint64_t>{7 * 64, 7 * 64, 11 * 64});
    CHECK(counts.outside()[2 * 3 + 1] == 4 * PairCounts::line);
    CHECK(counts.pairs() == 2);
    const SparseRows rows = take_rows(counts);
    CHECK(rows.start == std::vector<std::uint64_t>{0, 1, 2, 3});
    CHECK(rows.column == std::vector<std::uint32_t>{0, 2, 1});
    CHECK(rows.value == std::vector<double>{6 * 64, 7 * 64, 7 * 64});
}

TEST_CASE("one result on any number of threads, also of a mesh") {
    for (const Scene& scene : {street(), concentric_balls(0.5, 1, 8)}) {
        const Patches patches = make_patches(scene);
        std::string expected;
        for (unsigned threads : {1u, 2u, 3u, 7u}) {
            FactorSettings settings = some_lines();
            settings.threads = threads;
            settings.sky_parts = SkyParts::tregenza;
            const Factors factors = view_factors(scene, patches, settings);
            const TemporaryFile npz("f.npz"), sky("f.csv");
            write_factors(npz.path(), factors, FactorValues::exchange);
            write_sky_factors(sky.path(), factors);
            const std::string all = npz.text() + sky.text();
            if (expected.empty())
                expected = all;
            CHECK((all == expected));
        }
    }
}

TEST_CASE("rows that few lines left close all the same, and say so") {
    const Scene scene = street();
    const Patches patches = make_patches(scene);
    FactorSettings settings;
    settings.bundles = 3;
    settings.line_spacing = 1;
    const Factors factors = view_factors(scene, patches, settings);
    const FactorCheck check = check_factors(factors);
    CHECK(factors.unseen > 0);
    CHECK(factors.rest > 0);
    CHECK(!factors.warnings.empty());
    CHECK(check.row_deviation < 1e-12);
    CHECK(check.reciprocity == 0);
    CHECK(check.smallest >= 0);
}

TEST_CASE("an account that no scaling closes is cut and filled up") {
    // Row 0 sees row 1 alone, which has a tenth of its area.
    SparseRows counts;
    counts.start = {0, 1, 3, 4};
    counts.column = {1, 0, 2, 1};
    counts.value = {1, 1, 0.5, 0.5};
    const std::vector<double> area = {10, 1, 2}, outside = {0, 0, 1};
    const Account account = close_account(counts, outside, area, {}, 1);
    CHECK(account.rest > 8.9);
    for (std::size_t i = 0; i < 3; ++i) {
        double sum = account.outside[i];
        for (std::uint64_t k = account.exchange.start[i]; k < account.exchange.start[i + 1]; ++k)
            sum += account.exchange.value[k];
        CHECK(std::fabs(sum - area[i]) < 1e-12 * area[i]);
    }
}

TEST_CASE("more memory than allowed is refused before it is taken") {
    const Scene scene = street();
    const Patches patches = make_patches(scene, {.size = 0.02});
    FactorSettings settings = some_lines();
    for (std::uint64_t limit : {std::uint64_t(1) << 20, std::uint64_t(300) << 20}) {
        settings.max_memory = limit;
        bool refused = false;
        try {
            view_factors(scene, patches, settings);
        } catch (const Error& error) {
            refused = error.fault() == Fault::memory;
        }
        CHECK(refused);
    }
}
