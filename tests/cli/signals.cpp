#include <doctest/doctest.h>

#include <chrono>
#include <csignal>

#include <nlohmann/json.hpp>

#include "cli/run.h"

// Ctrl-C and SIGTERM. Each case names the planted error that makes it fail.

namespace {

/// A solve that goes on far longer than the test may take.
std::vector<std::string> long_solve(const Workplace& place, const std::string& first_shot) {
    return {"solve",    place.scene(),   "--patches", "600",           "--bundles",
            "10000000", "--first-shot",  first_shot,  "--progress",    "json",
            "--table",  place / "t.csv", "--stats",   place / "s.json"};
}

constexpr const char* in_bundles = "\"stage\":\"bundles\"";
constexpr const char* in_first_shot = "\"stage\":\"first shot\"";

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

// Planted: the callback's answer ignored; a partial result that does not say so.
TEST_CASE("one signal gives a partial result within 5 s and code 130") {
    for (int signal : {SIGINT, SIGTERM}) {
        // Each in another stage: the first shot has to listen as well.
        bool early = signal == SIGTERM;
        Workplace place;
        Running solve(place, long_solve(place, early ? "rays" : "none"));
        solve.wait_for(early ? in_first_shot : in_bundles);
        auto start = std::chrono::steady_clock::now();
        solve.send(signal);
        Outcome outcome = solve.wait();
        CAPTURE(outcome.err);
        CHECK(seconds_since(start) < 5);
        CHECK(outcome.code == 130);
        CHECK(place.files() == std::vector<std::string>{"s.json", "t.csv"});
        auto stats = nlohmann::json::parse(read_file(place / "s.json"));
        CHECK(stats["partial"] == true);
        CHECK(stats["energy"]["residual"] == nlohmann::json({0, 0, 0}));
        CHECK(run(place, {"compare", place / "t.csv", place / "t.csv"}).code == 0);
    }
}

// Planted: the second signal counted but not acted upon; temporaries left behind.
TEST_CASE("a second signal ends the program within 1 s and leaves nothing") {
    Workplace place;
    Running solve(place, long_solve(place, "none"));
    solve.wait_for(in_bundles);
    auto start = std::chrono::steady_clock::now();
    solve.send(SIGINT);
    solve.send(SIGTERM);
    Outcome outcome = solve.wait();
    CHECK(seconds_since(start) < 1);
    CHECK(outcome.code == 130);
    // The files are whole where the second signal came after they were written, else absent.
    for (const std::string& name : place.files())
        CHECK((name == "s.json" || name == "t.csv"));
}

// Planted: a limit that is looked at only between stages.
TEST_CASE("a time limit gives a partial result and code 0") {
    Workplace place;
    std::vector<std::string> arguments = long_solve(place, "none");
    arguments.insert(arguments.end(), {"--time-limit", "0.5"});
    auto start = std::chrono::steady_clock::now();
    Outcome outcome = run(place, arguments);
    CAPTURE(outcome.err);
    CHECK(seconds_since(start) < 5.5);
    CHECK(outcome.code == 0);
    CHECK(nlohmann::json::parse(read_file(place / "s.json"))["partial"] == true);
}

// Planted: text between the objects, a stage that never ends.
TEST_CASE("progress as JSON is one object a line") {
    Workplace place;
    Outcome outcome = run(place, {"solve", place.scene(), "--patches", "60", "--bundles", "64",
                                  "--progress", "json"});
    REQUIRE(outcome.code == 0);
    double done = 0;
    std::string line;
    for (char c : outcome.err) {
        if (c != '\n') {
            line += c;
            continue;
        }
        if (!line.starts_with("warning: "))
            done = nlohmann::json::parse(line)["done"];
        line.clear();
    }
    CHECK(done == 1);
}
