#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <nlohmann/json.hpp>

#include "cli/run.h"
#include "random.h"
#include "support/soak.h"

// Runs that signals end, and what they leave. Each case names the planted errors that were seen to
// fail it.

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// A solve of about half a second that states its error.
std::vector<std::string> solve_of(const Workplace& place, std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "solve",   place.scene(),  "--patches", "400",     "--bundles",     "12000",
        "--quiet", "--first-shot", "rays",      "--stats", place / "s.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

nlohmann::json stats_of(const Workplace& place) {
    return nlohmann::json::parse(read_file(place / "s.json"));
}

}  // namespace

// 100 random moments. Planted, each seen to fail: the checkpoint of a stopped run not written; the
// signals not asked for between batches. A second signal while the disk is slow: faults/odd.sh.
TEST_CASE("SIGTERM and SIGINT are answered in 5 s with a resumable state, a second in 1 s") {
    Workplace place;
    const auto start = Clock::now();
    Outcome outcome = run(place, solve_of(place, {"--threads", "2"}));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const double whole = seconds_since(start);
    const std::string hash = stats_of(place)["solution_hash"];
    int stopped = 0, early = 0;
    for (std::uint64_t k = 0; k < 100; ++k) {
        CAPTURE(k);
        for (const char* name : {"c.plx", "s.json"})
            std::filesystem::remove(place / name);
        Running solve(place, solve_of(place, {"--threads", k % 2 ? "1" : "2", "--checkpoint",
                                              place / "c.plx"}));
        const double moment =
            whole * double(parallux::mix64(k + 100 * parallux::test::soak_round()) >> 11) * 0x1p-53;
        std::this_thread::sleep_for(std::chrono::duration<double>(moment));
        const auto sent = Clock::now();
        solve.send(k % 3 ? SIGTERM : SIGINT);
        const bool twice = k % 4 == 3;
        if (twice)
            solve.send(SIGTERM);
        outcome = solve.wait();
        CHECK(seconds_since(sent) < (twice ? 1 : 5));
        CAPTURE(outcome.err);
        // Before its first line the system ends it.
        const bool unborn = outcome.code == -1 && outcome.err.empty() && place.files().empty();
        CHECK((outcome.code == 130 || outcome.code == 0 || unborn));
        for (const std::string& name : place.files())
            CHECK((name == "c.plx" || name == "s.json"));
        if (!std::filesystem::exists(place / "c.plx")) {
            // It was not yet begun, was over but for its files, or was told twice.
            const bool over =
                std::filesystem::exists(place / "s.json") && !stats_of(place)["partial"];
            CHECK((twice || over || outcome.err.empty()));
            ++early;
            continue;
        }
        if (twice || outcome.code == 0)
            continue;
        ++stopped;
        CHECK(outcome.one_line("--resume"));
        if (stopped % 4 == 0) {
            outcome =
                run(place,
                    solve_of(place, {"--threads", k % 2 ? "3" : "1", "--resume", place / "c.plx"}));
            CAPTURE(outcome.err);
            CHECK(outcome.code == 0);
            CHECK(stats_of(place)["solution_hash"] == hash);
            CHECK(stats_of(place)["partial"] == false);
        }
    }
    MESSAGE(stopped, " stopped, ", early, " before there was anything to keep");
    CHECK(stopped > 20);
}

// Planted, seen to fail: SIGUSR1 left to the system, which ends the program.
TEST_CASE("SIGUSR1 asks for a checkpoint, and the run goes on to the same bits") {
    Workplace place;
    std::vector<std::string> whole = solve_of(place, {"--checkpoint", place / "c.plx"});
    whole.erase(std::find(whole.begin(), whole.end(), "--quiet"));
    whole.insert(whole.end(), {"--progress", "json"});
    Running solve(place, whole);
    solve.wait_for("\"stage\":\"bundles\"");
    solve.send(SIGUSR1);
    const Outcome outcome = solve.wait();
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(std::filesystem::exists(place / "c.plx"));
    const std::string hash = stats_of(place)["solution_hash"];
    CHECK(run(place, solve_of(place, {"--resume", place / "c.plx"})).code == 0);
    CHECK(stats_of(place)["solution_hash"] == hash);
}

// Planted, seen to fail: a stopped run that keeps nothing.
TEST_CASE("a time limit leaves a checkpoint, and one file may be resumed from and kept in") {
    Workplace place;
    CHECK(run(place, solve_of(place, {})).code == 0);
    const std::string hash = stats_of(place)["solution_hash"];
    // A limit that this machine cannot meet, whatever its speed.
    double limit = stats_of(place)["seconds"]["total"];
    std::vector<std::string> more;
    auto run_limited = [&] {
        const Outcome outcome = run(place, solve_of(place, more));
        CAPTURE(outcome.err);
        REQUIRE(outcome.code == 0);
        return stats_of(place)["partial"] == true;
    };
    do {
        limit /= 4;
        REQUIRE(limit > 1e-9);
        more = {"--time-limit", nlohmann::json(limit).dump(), "--checkpoint", place / "c.plx"};
    } while (!run_limited());
    REQUIRE(std::filesystem::exists(place / "c.plx"));
    more.insert(more.end(), {"--resume", place / "c.plx"});
    int runs = 0;
    while (run_limited())
        REQUIRE(++runs < 1000);
    CHECK(stats_of(place)["solution_hash"] == hash);
}

// Planted, seen to fail: code 70 for a checkpoint that is none.
TEST_CASE("a checkpoint that is none, foreign or not to be written ends with its code and a line") {
    Workplace place;
    Outcome outcome = run(place, solve_of(place, {"--resume", place / "absent.plx"}));
    CHECK(outcome.code == 3);
    CHECK(outcome.one_line("absent.plx"));
    outcome = run(place, solve_of(place, {"--resume", place.scene()}));
    CHECK(outcome.code == 3);
    CHECK(outcome.one_line("not a checkpoint"));
    outcome = run(place, solve_of(place, {"--time-limit", "0.1", "--checkpoint", place / "c.plx"}));
    REQUIRE(outcome.code == 0);
    outcome = run(place, solve_of(place, {"--seed", "2", "--resume", place / "c.plx"}));
    CHECK(outcome.code == 3);
    CHECK(outcome.one_line("other settings"));
    outcome = run(place, solve_of(place, {"--patch-size", "0.5", "--resume", place / "c.plx"}));
    CHECK(outcome.code != 0);
    outcome = run(place, solve_of(place, {"--checkpoint", place / "no/c.plx"}));
    CHECK(outcome.code == 4);
    CHECK(outcome.one_line("no/c.plx"));
    outcome = run(place, solve_of(place, {"--checkpoint", place.scene()}));
    CHECK(outcome.code == 2);
}
