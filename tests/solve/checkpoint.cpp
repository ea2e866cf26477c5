#include <doctest/doctest.h>

#include <filesystem>

#include "parallux/solve.h"
#include "random.h"
#include "solve/interrupted.h"
#include "support/soak.h"

// Runs that are interrupted and taken up again. Cases name the planted errors that were seen to
// fail them.

using namespace parallux;
using namespace parallux::test;

namespace {

void check_equal(const Solution& a, const Solution& b) {
    CHECK(a.hash == b.hash);
    CHECK(a.stderror == b.stderror);
    CHECK(a.relative_rms_bound == b.relative_rms_bound);
    CHECK(a.crossings == b.crossings);
    CHECK(a.bundles == b.bundles);
    CHECK(a.groups == b.groups);
    CHECK(a.first_shot_rays == b.first_shot_rays);
    CHECK(a.shots == b.shots);
    CHECK(a.counts.lines == b.counts.lines);
    CHECK(a.counts.transfers == b.counts.transfers);
    CHECK(a.counts.met_backs == b.counts.met_backs);
    CHECK(a.energy.emitted == b.energy.emitted);
    CHECK(a.energy.escaped == b.energy.escaped);
    CHECK(a.energy.residual == b.energy.residual);
    CHECK(a.warnings == b.warnings);
    CHECK(!b.partial);
}

}  // namespace

// Planted, each seen to fail: the dither, the batch or other workers' totals not taken up; the
// state kept after the stop was acted upon; emission not darkened; quanta of a gather taken for the
// pass's when a checkpoint is judged.
TEST_CASE("interrupted anywhere and resumed on other threads: the same bits") {
    unsigned threads = 0;
    for (Kind& kind : kinds()) {
        CAPTURE(kind.name);
        const Patches patches = make_patches(kind.scene);
        kind.settings.threads = 2;
        const Solution whole = solve(kind.scene, patches, kind.settings);
        const std::uint64_t count = answers(kind, patches);
        const std::uint64_t tries = std::min<std::uint64_t>(count, 16);
        REQUIRE(count > 10);
        for (std::uint64_t k = 0; k < tries; ++k) {
            // All where they are few; else the first and the last ones, and between at random.
            std::uint64_t at =
                k < 8 || count <= tries ? k : count - 1 - mix64(k + 100 * soak_round()) % count;
            CAPTURE(at);
            SolveSettings first = kind.settings;
            first.threads = 1 + ++threads % 3;
            first.checkpoints.file = file;
            std::uint64_t calls = 0;
            solve(kind.scene, patches, first, [&](const Progress&) { return calls++ != at; });
            SolveSettings second = kind.settings;
            second.threads = 1 + (threads + 1 + unsigned(k % 2)) % 3;
            second.checkpoints.resume = file;
            check_equal(whole, solve(kind.scene, patches, second));
        }
    }
    std::filesystem::remove(file);
}

// Found by a crash of the program in tests/faults/kill.sh. Planted, seen to fail: no stage before
// the first one that is told.
TEST_CASE("a run that is taken up within a later group's first shot tells of a stage") {
    Kind kind{"", room(grey(0.5, 1), 1), {}};
    kind.settings.bundles = 64;
    kind.settings.groups = 2;
    kind.settings.first_shot = FirstShot::rays;
    kind.settings.first_shot_rays = 1000;
    const Patches patches = make_patches(kind.scene);
    const std::uint64_t count = answers(kind, patches);
    for (std::uint64_t at = 0; at < count; ++at) {
        SolveSettings first = kind.settings, second = kind.settings;
        first.checkpoints.file = second.checkpoints.resume = file;
        std::uint64_t calls = 0;
        solve(kind.scene, patches, first, [&](const Progress&) { return calls++ != at; });
        solve(kind.scene, patches, second, [](const Progress& progress) {
            REQUIRE(progress.stage != nullptr);
            return *progress.stage != 0;
        });
    }
    std::filesystem::remove(file);
}

// Planted, seen to fail: a resumed run that forgets the rounds before.
TEST_CASE("interrupted over and over, kept in one file: the same bits") {
    for (std::size_t which : {0u, 3u, 6u}) {
        const Kind kind = kinds()[which];
        CAPTURE(kind.name);
        const Patches patches = make_patches(kind.scene);
        const Solution whole = solve(kind.scene, patches, kind.settings);
        std::filesystem::remove(file);
        // What every run prepares anew is asked about as well.
        const std::uint64_t most = 16 + answers(kind, patches) / 8;
        for (unsigned run = 0;; ++run) {
            SolveSettings settings = kind.settings;
            settings.threads = 1 + run % 3;
            settings.checkpoints.file = file;
            if (run > 0)
                settings.checkpoints.resume = file;
            std::uint64_t calls = 0;
            const Solution solution = solve(kind.scene, patches, settings,
                                            [&](const Progress&) { return ++calls < most; });
            REQUIRE(run < 50);
            if (solution.partial)
                continue;
            CHECK(run > 2);
            check_equal(whole, solution);
            break;
        }
    }
    std::filesystem::remove(file);
}

// Planted, seen to fail: what is asked for not looked at.
TEST_CASE("kept as often as can be, a run has the same bits, and so has one from what is left") {
    const Kind kind = kinds()[0];
    const Patches patches = make_patches(kind.scene);
    const Solution whole = solve(kind.scene, patches, kind.settings);
    SolveSettings settings = kind.settings;
    settings.threads = 3;
    settings.checkpoints.file = file;
    settings.checkpoints.every = 0;
    int written = 0;
    settings.checkpoints.written = [&](const std::string& failure) {
        CHECK(failure == "");
        ++written;
    };
    check_equal(whole, solve(kind.scene, patches, settings));
    CHECK(written > 0);
    settings.checkpoints = {};
    settings.checkpoints.resume = file;
    check_equal(whole, solve(kind.scene, patches, settings));
    // One that is wanted now is written now.
    settings.checkpoints = {};
    settings.checkpoints.file = file;
    int calls = 0;
    written = 0;
    settings.checkpoints.wanted = [&] { return ++calls == 5; };
    settings.checkpoints.written = [&](const std::string&) { ++written; };
    solve(kind.scene, patches, settings);
    CHECK(written == 1);
    std::filesystem::remove(file);
}

// Failed while a run that was stopped in the trial of its rays had no group at all, and so no
// values.
TEST_CASE("stopped at once, a run has a value for every patch") {
    for (const Kind& kind : kinds()) {
        CAPTURE(kind.name);
        const Patches patches = make_patches(kind.scene);
        const Solution solution =
            solve(kind.scene, patches, kind.settings, [](const Progress&) { return false; });
        CHECK(solution.partial);
        CHECK(solution.groups == 1);
        REQUIRE(solution.radiosity.size() == patches.count() * patches.bands);
        for (std::int64_t residual : solution.energy.residual)
            CHECK(residual == 0);
    }
}

// Planted, seen to fail: the failure thrown by the solve.
TEST_CASE("a checkpoint that cannot be written is told, and the run goes on") {
    const Kind kind = kinds()[0];
    const Patches patches = make_patches(kind.scene);
    SolveSettings settings = kind.settings;
    const Solution whole = solve(kind.scene, patches, settings);
    settings.checkpoints.file = "/nowhere/at/all.plx";
    settings.checkpoints.every = 0;
    int failed = 0;
    settings.checkpoints.written = [&](const std::string& failure) {
        CHECK(failure.find("/nowhere/at/all.plx") != std::string::npos);
        ++failed;
    };
    check_equal(whole, solve(kind.scene, patches, settings));
    CHECK(failed > 0);
}
