#include <doctest/doctest.h>

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "cli/run.h"

// `parallux factors` as a user types it.

namespace {

Outcome factors(const Workplace& place, std::vector<std::string> more) {
    more.insert(more.begin(), {"factors", place.scene(), "--bundles", "64"});
    return run(place, more);
}

}  // namespace

TEST_CASE(
    "factors writes the matrix, the areas, the sky and a report that says how good they are") {
    Workplace place;
    const Outcome outcome = factors(
        place, {"-o", place / "f.mtx", "--sky", place / "sky.csv", "--stats", place / "f.json",
                "--sky-parts", "tregenza", "--patches", "100", "--quiet"});
    CHECK(outcome.code == 0);
    CHECK(outcome.err == "");
    CHECK(place.files() == std::vector<std::string>{"f.areas.csv", "f.json", "f.mtx", "sky.csv"});
    CHECK(
        read_file(place / "f.mtx").starts_with("%%MatrixMarket matrix coordinate real symmetric"));
    CHECK(read_file(place / "sky.csv").starts_with("node,sky,stderr_sky,ground,backs,sky_1"));
    const auto stats = nlohmann::json::parse(read_file(place / "f.json"));
    CHECK(stats["row_sums"]["largest_deviation"] < 1e-12);
    CHECK(stats["reciprocity"]["largest_deviation_m2"] == 0);
    CHECK(stats["unresolved"]["leaks"] == 0);
    CHECK(stats["error"]["rms_factor"] > 0);
    CHECK(stats["predicted_memory_bytes"] > 0);
}

// Planted, seen: the period not handed on; names read and nothing taken out.
TEST_CASE("factors of a scene that repeats, and without what is excluded") {
    Workplace place;
    auto matrix = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"-o", place / "f.mtx", "--between", "surfaces", "--quiet"});
        const Outcome outcome = factors(place, more);
        CAPTURE(outcome.err);
        CHECK(outcome.code == 0);
        return read_file(place / "f.mtx") + read_file(place / "f.areas.csv");
    };
    const std::string alone = matrix({}), repeated = matrix({"--periodic", "2,2"}),
                      fewer = matrix({"--exclude", "light"});
    CHECK(repeated != alone);
    CHECK(alone.find("light") != std::string::npos);
    CHECK(fewer.find("light") == std::string::npos);
}

TEST_CASE("factors says no with one line") {
    Workplace place;
    struct Case {
        std::vector<std::string> arguments;
        int code;
        std::string named;
    };
    for (const Case& c : std::vector<Case>{
             {{}, 2, "factors needs -o"},
             {{"-o", place / "f.csv"}, 2, "-o"},
             {{"-o", place / "f.mtx", "--sky-parts", "12"}, 2, "--sky-parts 12"},
             {{"-o", place / "f.mtx", "--between", "walls"}, 2, "--between walls"},
             {{"-o", place / "f.mtx", "--threshold", "2"}, 2, "--threshold 2"},
             {{"-o", place / "f.mtx", "--periodic", "0,0"}, 2, "--periodic 0,0"},
             {{"-o", place / "f.mtx", "--periodic", "2,2", "--line-spacing", "1e-5"}, 2, "spacing"},
             {{"-o", place / "f.mtx", "--exclude", "nobody"}, 2, "nobody"},
             {{"-o", place / "f.mtx", "--exclude", "*"}, 2, "--exclude"},
             {{"-o", place / "f.mtx", "--facets", "--patches", "9"}, 2, "--facets"},
             {{"-o", place / "f.mtx", "--sky", place / "f.areas.csv"}, 2, "two outputs"},
             {{"-o", place / "none/f.mtx"}, 4, "none"},
             {{"-o", place / "f.mtx", "--max-memory", "10M"}, 5, "MiB"}}) {
        const Outcome outcome = factors(place, c.arguments);
        CAPTURE(outcome.err);
        CHECK(outcome.code == c.code);
        CHECK(outcome.one_line(c.named));
        CHECK(place.files().empty());
    }
}

namespace {

// n × n blocks on as many pieces of ground: 12 triangles of two sides each for one.
std::string blocks(int n) {
    std::string text;
    int corners = 0;
    auto plate = [&](std::array<double, 3> o, std::array<double, 3> u, std::array<double, 3> v) {
        for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
            text += "v";
            for (int d = 0; d < 3; ++d)
                text += " " + std::to_string(o[d] + a * u[d] + b * v[d]);
            text += "\n";
        }
        auto index = [&](int k) { return " " + std::to_string(corners + k); };
        text +=
            "f" + index(1) + index(2) + index(3) + "\nf" + index(1) + index(3) + index(4) + "\n";
        corners += 4;
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = i, y = j, h = 0.3 + 0.1 * ((7 * i + 3 * j) % 11), a = 0.6;
            plate({x - 0.2, y - 0.2, 0}, {1, 0, 0}, {0, 1, 0});
            plate({x, y, h}, {a, 0, 0}, {0, a, 0});
            plate({x, y, 0}, {a, 0, 0}, {0, 0, h});
            plate({x, y + a, 0}, {0, 0, h}, {a, 0, 0});
            plate({x, y, 0}, {0, 0, h}, {0, a, 0});
            plate({x + a, y, 0}, {0, a, 0}, {0, 0, h});
        }
    return text;
}

}  // namespace

// The peak is 70 to 100 % of what was foretold. Planted, seen to fail: 64 MiB in place of 88 and 16
// numbers a node in place of 64, as was stated before.
TEST_CASE("factors foretell the memory that they take, from 1000 to 20 000 facets") {
    Workplace place;
    for (const int n : {7, 20, 29})
        for (const std::vector<std::string>& more :
             {std::vector<std::string>{"--groups", "1"},
              {"--groups", "8"},
              {"--groups", "8", "--threshold", "1e-3", "--sky-parts", "tregenza"}}) {
            write_file(place / "town.obj", blocks(n));
            std::vector<std::string> arguments{
                "factors", place / "town.obj", "--facets", "--bundles",
                "128",     "--threads",        "2",        "--quiet",
                "-o",      place / "f.npz",    "--stats",  place / "f.json"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const Outcome outcome = run(place, arguments);
            CAPTURE(outcome.err);
            REQUIRE(outcome.code == 0);
            const auto stats = nlohmann::json::parse(read_file(place / "f.json"));
            const double peak = stats["peak_memory_bytes"].get<double>();
            const double share = peak / stats["predicted_memory_bytes"].get<double>();
            MESSAGE(stats["nodes"] << " facets, " << peak / (1 << 20) << " MiB, " << 100 * share
                                   << " % of what was foretold");
            CHECK(share > 0.7);
            CHECK(share < 1);
        }
}
