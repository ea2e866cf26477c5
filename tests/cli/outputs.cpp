#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "cli/run.h"

// What a solve leaves. Each case names the planted error that makes it fail.

namespace {

std::vector<std::string> solve(const Workplace& place, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"solve",     place.scene(), "--patches",  "60",
                                          "--bundles", "64",          "--progress", "off"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items())
        keys.push_back(key);
    return keys;
}

}  // namespace

// Planted: a column left out or renamed, a row too few, a key missing.
TEST_CASE("table and statistics have exactly the promised columns and keys") {
    Workplace place;
    Outcome outcome =
        run(place, solve(place, {"--table", place / "t.csv", "--stats", place / "s.json"}));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    auto stats = nlohmann::ordered_json::parse(read_file(place / "s.json"));
    auto rows = lines_of(read_file(place / "t.csv"));
    CHECK(rows.at(0) ==
          "patch,surface,name,material,iu,iv,x,y,z,nx,ny,nz,area,side,"
          "reflectance_r,emission_r,irradiance_r,radiosity_r,stderr_r,"
          "reflectance_g,emission_g,irradiance_g,radiosity_g,stderr_g,"
          "reflectance_b,emission_b,irradiance_b,radiosity_b,stderr_b");
    CHECK(rows.size() == stats["patches"].get<std::size_t>() + 1);
    CHECK(keys_of(stats) == std::vector<std::string>{"scene",
                                                     "patches",
                                                     "surfaces",
                                                     "bands",
                                                     "method",
                                                     "seed",
                                                     "threads",
                                                     "bundles",
                                                     "lines",
                                                     "line_spacing",
                                                     "batch",
                                                     "first_shot_rays",
                                                     "shots",
                                                     "hits",
                                                     "transfers",
                                                     "average_list",
                                                     "average_nonempty_list",
                                                     "leaks",
                                                     "seconds",
                                                     "lines_per_second",
                                                     "peak_memory_bytes",
                                                     "predicted_memory_bytes",
                                                     "energy",
                                                     "groups",
                                                     "error",
                                                     "solution_hash",
                                                     "partial",
                                                     "version",
                                                     "isa",
                                                     "warnings"});
    CHECK(keys_of(stats["seconds"]) == std::vector<std::string>{"load", "patches", "first_shot",
                                                                "global", "serial", "gather",
                                                                "output", "total"});
    CHECK(keys_of(stats["energy"]) == std::vector<std::string>{"emitted", "absorbed", "escaped",
                                                               "unshot", "residual", "quanta"});
    CHECK(stats["energy"]["residual"] == nlohmann::ordered_json({0, 0, 0}));
    CHECK(stats["solution_hash"].get<std::string>().size() == 16);
    CHECK(stats["partial"] == false);
    CHECK(stats["error"]["relative_rms"].is_null());
    CHECK(outcome.out.find("patches") != std::string::npos);
    CHECK(place.files() == std::vector<std::string>{"s.json", "t.csv"});
}

// Planted: sums that depend on the order in which workers add.
TEST_CASE("equal runs have equal hashes and tables, whatever the threads") {
    Workplace place;
    std::set<std::string> hashes, tables;
    for (std::string threads : {"1", "2", "3", "7"}) {
        Outcome outcome = run(place, solve(place, {"--threads", threads, "--table", place / "t.csv",
                                                   "--stats", place / "s.json", "--quiet"}));
        REQUIRE(outcome.code == 0);
        CHECK(outcome.out + outcome.err == "");
        hashes.insert(nlohmann::json::parse(read_file(place / "s.json"))["solution_hash"]);
        tables.insert(read_file(place / "t.csv"));
    }
    CHECK(hashes.size() == 1);
    CHECK(tables.size() == 1);
    run(place, solve(place, {"--seed", "2", "--stats", place / "s.json"}));
    hashes.insert(nlohmann::json::parse(read_file(place / "s.json"))["solution_hash"]);
    CHECK(hashes.size() == 2);
}

// Planted: outputs opened only after the solve, so that an hour is lost; or the code 70.
TEST_CASE("outputs that cannot be written are refused before the solve with code 4") {
    Workplace place;
    write_file(place / "file", "");
    std::filesystem::create_directory(place / "folder.csv");
    for (std::string target : {place / "missing/t.csv", place / "file/t.csv", place / "folder.csv",
                               std::string("/proc/parallux.csv")}) {
        // So many bundles that a solve would be ended by the test's time limit.
        Outcome outcome = run(place, {"solve", place.scene(), "--bundles", "100000000", "--stats",
                                      place / "s.json", "--table", target});
        CAPTURE(outcome.err);
        CHECK(outcome.code == 4);
        CHECK(outcome.one_line(target));
    }
    CHECK(place.files() == std::vector<std::string>{"file", "folder.csv"});
}

// Planted: the target truncated when checked, or written in place.
TEST_CASE("an older file stays whole when a run fails") {
    Workplace place;
    write_file(place / "t.csv", "older");
    CHECK(run(place, solve(place, {"--table", place / "t.csv", "--max-memory", "1K"})).code == 5);
    CHECK(run(place, {"solve", place / "missing.obj", "--table", place / "t.csv"}).code == 3);
    CHECK(run(place, solve(place, {"--table", place / "t.csv", "--stats", place / "no/s"})).code ==
          4);
    CHECK(read_file(place / "t.csv") == "older");
    CHECK(place.files() == std::vector<std::string>{"t.csv"});
}

// Planted: names compared as text, so that ./a and a, or a link, pass for two files.
TEST_CASE("one file for two outputs, or for scene and output, is refused with code 2") {
    Workplace place;
    const std::string scene = read_file(place.scene());
    std::filesystem::create_symlink(place.scene(), place / "link.csv");
    CHECK(run(place, solve(place, {"--table", place / "x", "--stats", place / "x"})).code == 2);
    CHECK(run(place, solve(place, {"--table", place / "x", "--stats", place / "./x"})).code == 2);
    CHECK(run(place, solve(place, {"--image", place / "x.png", "--image", place / "x.png"})).code ==
          2);
    CHECK(run(place, solve(place, {"--table", place.scene()})).code == 2);
    CHECK(run(place, solve(place, {"--table", place / "link.csv"})).code == 2);
    CHECK(read_file(place.scene()) == scene);
}

// Planted: the tolerance compared with the absolute RMS, or >= for >.
TEST_CASE("compare: code 0 within the tolerance, 1 above, 3 for no table") {
    Workplace place;
    REQUIRE(run(place, solve(place, {"--table", place / "a.csv"})).code == 0);
    REQUIRE(run(place, solve(place, {"--table", place / "b.csv", "--seed", "9"})).code == 0);
    REQUIRE(run(place, {"solve", place.scene(), "--patches", "200", "--bundles", "16", "--table",
                        place / "c.csv"})
                .code == 0);
    CHECK(run(place, {"compare", place / "a.csv", place / "a.csv", "--tolerance", "0"}).code == 0);
    CHECK(run(place, {"compare", place / "a.csv", place / "b.csv"}).code == 0);
    CHECK(run(place, {"compare", place / "a.csv", place / "b.csv", "--tolerance", "0.5"}).code ==
          0);
    Outcome above =
        run(place, {"compare", place / "a.csv", place / "b.csv", "--tolerance", "1e-9"});
    CHECK(above.code == 1);
    CHECK(above.one_line("tolerance"));
    CHECK(above.out.find("relative RMS") != std::string::npos);
    for (std::string other : {place / "c.csv", place.scene(), place / "missing.csv"}) {
        Outcome outcome = run(place, {"compare", place / "a.csv", other});
        CHECK(outcome.code == 3);
        CHECK(outcome.one_line(place / ""));
    }
}

// Planted: pictures rendered but written under one name only; a default camera without a word.
TEST_CASE("pictures in both formats, with a warning where the scene has no camera") {
    Workplace place;
    Outcome outcome = run(place, solve(place, {"--image", place / "a.png", "--image",
                                               place / "a.exr", "--size", "16x8"}));
    CAPTURE(outcome.err);
    CHECK(outcome.code == 0);
    CHECK(place.files() == std::vector<std::string>{"a.exr", "a.png"});
    CHECK(read_file(place / "a.png").substr(1, 3) == "PNG");
    CHECK(outcome.err.find("warning: ") != std::string::npos);
    CHECK(outcome.err.find("--camera") != std::string::npos);
    CHECK(run(place, solve(place, {"--image", place / "b.png", "--camera", "nobody"})).code == 2);
}

// Planted: a key of the text form that --json forgets; π left out, or one side of a two-sided
// light. Seen: curved surfaces called parallelograms.
TEST_CASE("info tells what the scene holds") {
    Workplace place;
    Outcome text = run(place, {"info", place.scene()});
    CAPTURE(text.err);
    CHECK(text.code == 0);
    for (const char* word : {"surfaces", "triangles", "materials", "emitters", "area", "bounds"})
        CHECK(text.out.find(word) != std::string::npos);
    Outcome json = run(place, {"info", "--json", place.scene()});
    CHECK(json.code == 0);
    auto info = nlohmann::json::parse(json.out);
    CHECK(info["surfaces"] == 6);
    CHECK(info["parallelograms"] == 6);
    CHECK(info["area"].get<double>() == doctest::Approx(6));
    CHECK(info["closed"] == true);
    CHECK(info["emitters"]["surfaces"] == 1);
    // E = π L from both sides of 1 m², because faces of an OBJ have two.
    CHECK(info["emitters"]["power"][0].get<double>() == doctest::Approx(2 * 3 * 3.14159265));
    CHECK(info["bounds"]["high"] == nlohmann::json({1.0, 1.0, 1.0}));
    CHECK(info["curved"] == 0);
    info = nlohmann::json::parse(
        run(place, {"info", "--json", PARALLUX_SCENES "/curved_room.json"}).out);
    CHECK(info["parallelograms"] == 5);
    CHECK(info["curved"] == 9);
}

// Planted: a method that the parser maps to another, or whose settings the summary does not know.
TEST_CASE("every method is run, named in the statistics, and told in the summary") {
    Workplace place;
    struct Case {
        std::vector<std::string> arguments;
        std::string method, told;
    };
    const std::vector<Case> cases = {
        {{"--method", "bundles"}, "bundles", "bundles"},
        {{"--method", "lines"}, "lines", "one after the other"},
        {{"--method", "lines", "--batch", "2"}, "lines", "from one snapshot"},
        {{"--method", "lines", "--first-shot", "exact", "--shots", "3"}, "lines", "one after"},
        {{"--method", "progressive", "--shots", "7"}, "progressive", "in 7 shots"},
        {{"--method", "particles"}, "particles", "walked by particles"},
        {{"--method", "matrix"}, "matrix", "counted"},
    };
    for (const Case& one : cases) {
        std::vector<std::string> arguments = {
            "solve", place.scene(), "--patches",      "60",         "--lines",
            "20000", "--stats",     place / "s.json", "--progress", "off"};
        arguments.insert(arguments.end(), one.arguments.begin(), one.arguments.end());
        Outcome outcome = run(place, arguments);
        CAPTURE(one.told);
        CAPTURE(outcome.err);
        CHECK(outcome.code == 0);
        CHECK(outcome.out.find(one.told) != std::string::npos);
        CHECK(outcome.out.find("balance exact") != std::string::npos);
        CHECK(nlohmann::json::parse(read_file(place / "s.json"))["method"] == one.method);
    }
    // 200 000 patches would take 160 GB of counts.
    Outcome outcome = run(place, {"solve", place.scene(), "--patches", "200000", "--method",
                                  "matrix", "--max-memory", "1G", "--progress", "off"});
    CHECK(outcome.code == 5);
    CHECK(outcome.one_line("square of the patches"));
}

// Planted: lines that do not scale the error, or an error in per cent read as one in ones.
TEST_CASE("info --predict states the error of lines and the lines of an error") {
    Workplace place;
    auto predict = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"info",      "--json", "--predict",
                                              "--patches", "60",     place.scene()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Outcome outcome = run(place, arguments);
        CHECK(outcome.code == 0);
        return nlohmann::json::parse(outcome.out)["prediction"];
    };
    auto some = predict({"--lines", "1000"}), more = predict({"--lines", "4000"});
    CHECK(some["forms"].size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
        double few = some["forms"][k]["quadratic_error"],
               many = more["forms"][k]["quadratic_error"];
        CHECK(few == doctest::Approx(4 * many));
        double relative = some["forms"][k]["relative_rms"];
        auto back = predict({"--error", std::to_string(relative)});
        CHECK(back["forms"][k]["lines_for_error"].get<double>() ==
              doctest::Approx(1000).epsilon(1e-3));
    }
    // Both ways is better than one, and with a first shot than without.
    CHECK(some["forms"][0]["quadratic_error"] < some["forms"][1]["quadratic_error"]);
    CHECK(some["forms"][0]["quadratic_error"] < some["forms"][2]["quadratic_error"]);
    CHECK(run(place, {"info", place.scene(), "--lines", "5"}).code == 2);
    CHECK(run(place, {"info", place.scene(), "--predict"}).out.find("relative RMS") !=
          std::string::npos);
}
