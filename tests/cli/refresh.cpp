#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

#include "cli/run.h"

// Pictures while the run goes on. Each case names the planted error that makes it fail.

namespace {

std::vector<std::string> solve(const Workplace& place, const std::string& bundles,
                               std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "solve", place.scene(),  "--patches", "60",      "--bundles",      bundles,  "--groups",
        "64",    "--first-shot", "none",      "--stats", place / "s.json", "--size", "16x8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

/// Ten seconds and more on fast processors: a run must not end while its case still waits.
constexpr const char* many = "5000000";

void wait_for_file(const std::string& file) {
    for (int tries = 0; tries < 1500; ++tries) {
        if (std::filesystem::exists(file))
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("never came: " + file);
}

bool whole_png(const std::string& bytes) {
    return bytes.substr(1, 3) == "PNG" && bytes.size() > 100 &&
           bytes.substr(bytes.size() - 8, 4) == "IEND";
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++found;
    return found;
}

}  // namespace

// Planted, each seen to fail: a preview that takes the estimate's memory instead of a copy, which
// crashed; rounds sized by the time they took, which a refresh changes: another hash and picture.
TEST_CASE("pictures are refreshed while the run goes on, and end as without that") {
    Workplace place;
    {
        Running solving(place, solve(place, many,
                                     {"--image", place / "a.png", "--image", place / "a.exr",
                                      "--refresh", "0.001"}));
        wait_for_file(place / "a.exr");
        CHECK(whole_png(read_file(place / "a.png")));
        CHECK(!std::filesystem::exists(place / "s.json"));
        solving.send(SIGINT);
        CHECK(solving.wait().code == 130);
        CHECK(place.files() == std::vector<std::string>{"a.exr", "a.png", "s.json"});
    }
    // Bundles and rounds to a stated error alike.
    for (bool target : {false, true}) {
        std::vector<std::string> hashes, pictures;
        for (const char* refresh : {"1e9", "1e-9"}) {
            auto arguments =
                solve(place, "6400", {"--image", place / "a.png", "--quiet", "--refresh", refresh});
            if (target) {
                arguments.erase(arguments.begin() + 4, arguments.begin() + 8);
                arguments.insert(arguments.end(), {"--target-error", "0.005"});
            }
            Outcome outcome = run(place, arguments);
            CHECK(outcome.err == "");
            REQUIRE(outcome.code == 0);
            hashes.push_back(nlohmann::json::parse(read_file(place / "s.json"))["solution_hash"]);
            pictures.push_back(read_file(place / "a.png"));
        }
        CHECK(hashes[0] == hashes[1]);
        CHECK(pictures[0] == pictures[1]);
    }
}

// Planted, each seen to fail: the failure thrown on, which ended the run; a warning at every
// refresh (16 of them).
TEST_CASE("a refresh that cannot be written is told once; the last writing decides the code") {
    for (bool back : {true, false}) {
        Workplace place;
        const std::string folder = place / "sub";
        std::filesystem::create_directory(folder);
        Running solving(place, solve(place, many,
                                     {"--image", folder + "/a.png", "--refresh", "0.001",
                                      "--progress", "off"}));
        wait_for_file(folder + "/a.png");
        std::filesystem::rename(folder, place / "gone");
        solving.wait_for("warning: ");
        // Time for more groups, each of which fails again.
        std::this_thread::sleep_for(std::chrono::seconds(1));
        if (back)
            std::filesystem::create_directory(folder);
        solving.send(SIGINT);
        Outcome outcome = solving.wait();
        CAPTURE(outcome.err);
        CHECK(outcome.code == (back ? 130 : 4));
        CHECK(std::filesystem::exists(folder + "/a.png") == back);
        CHECK(std::filesystem::exists(place / "s.json"));
        CHECK(count(outcome.err, "not refreshed") == 1);
        CHECK(count(outcome.err, folder + "/a.png") == (back ? 1 : 2));
    }
}
