#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "output/fields.h"
#include "output/sealed_file.h"
#include "parallux/error.h"
#include "parallux/result.h"
#include "parallux/solve.h"
#include "random.h"
#include "solve/checkpoint.h"
#include "support/shaded_lamp.h"
#include "support/soak.h"

// Runs that are interrupted and taken up again. Cases name the planted errors that were seen to
// fail them.

using namespace parallux;
using namespace parallux::test;

namespace {

const std::string file =
    (std::filesystem::temp_directory_path() / "parallux_checkpoint_test.plx").string();

std::string bytes_of_file() {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

void write(const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

// Gives made-up bytes the checksum that they should have.
void seal(std::string& bytes) {
    Checksum sum;
    sum.add(std::string_view(bytes).substr(0, bytes.size() - sealed_tail));
    const std::uint64_t value = sum.value();
    std::memcpy(bytes.data() + bytes.size() - sealed_tail, &value, sealed_tail);
}

Scene lit_room() {
    const Material wall = grey(0.6), lamp = grey(0.4, 2, true);
    Scene scene = room({wall, wall, wall, wall, wall, lamp}, 4);
    scene.bands = 3;
    add_turned_cube(scene, {0.4, 0.5, 0.45}, 0.3, 2, grey(0.8));
    add_turned_cube(scene, {0.2, 0.7, 0.2}, 0.1, 1, grey(0.5, 1));
    add_light_and_sky(scene);
    return scene;
}

// A run of some kind, and one after the other of its interruptions.
struct Kind {
    const char* name;
    Scene scene;
    SolveSettings settings;
};

std::vector<Kind> kinds() {
    SolveSettings usual;
    usual.bundles = 160;
    usual.groups = 3;
    std::vector<Kind> all(10, {"", lit_room(), usual});
    all[0].name = "exact first shots, sky and lights";
    all[1].name = "rays, as many as a trial tells";
    for (std::size_t s = 0; s < 300; ++s)  // too many surfaces for exact ones
        add_quad(all[1].scene, {0.1, 0.1, 0.05 + 0.001 * double(s)}, {0.01, 0, 0}, {0, 0.01, 0});
    all[2].name = "rays in slabs";
    all[2].settings.first_shot = FirstShot::rays;
    all[2].settings.first_shot_rays = 3 << 19;
    all[3].name = "rounds to a stated error";
    all[3].settings = {};
    all[3].settings.target_error = 0.004;
    all[4].name = "shots from the brightest";
    all[4].settings.shots = 9;
    all[5].name = "lines in batches, one direction";
    all[5].settings = {};
    all[5].settings.method = Method::lines;
    all[5].settings.direction = Direction::oriented;
    all[5].settings.bundles = 100;
    all[5].settings.batch = 8;
    all[5].settings.first_shot = FirstShot::off;
    all[6].name = "patches too small for lines";
    all[6].scene = shaded_lamp();
    all[6].settings.bundles = 256;
    all[6].settings.groups = 2;
    all[6].settings.first_shot = FirstShot::rays;
    all[6].settings.first_shot_rays = 20000;
    all[7].name = "lights alone, whose direct light all groups share";
    all[7].settings.first_shot = FirstShot::off;
    all[8].name = "large batches, so that all workers keep lines, and no gather";
    for (Surface& surface : all[8].scene.surfaces)
        surface.grid_u = surface.grid_v = 16;
    all[8].settings.first_shot = FirstShot::off;
    all[8].settings.batch = 32;
    all[8].settings.groups = 1;
    all[8].settings.gather_share = 0;
    all[9].name = "few bundles, of which most gather, with quanta of their own";
    all[9].scene = room({grey(0.7), grey(0.7), grey(0.7), grey(0.7), grey(0.7), grey(0.7, 20)}, 3);
    all[9].settings = {};
    all[9].settings.bundles = 64;
    all[9].settings.batch = 1;
    all[9].settings.gather_share = 0.8;
    return all;
}

// How often a run asks whether to go on.
std::uint64_t answers(const Kind& kind, const Patches& patches) {
    std::uint64_t count = 0;
    solve(kind.scene, patches, kind.settings, [&](const Progress&) { return ++count > 0; });
    return count;
}

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

std::string refusal(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    try {
        solve(scene, patches, settings, [](const Progress&) { return false; });
        return "";
    } catch (const Error& error) {
        CHECK(error.fault() == Fault::input);
        return error.what();
    }
}

// A small run that was stopped within its second group's pass.
Kind stopped_run(int answers = 20) {
    Kind kind{"", room(grey(0.5, 1), 1), {}};
    kind.settings.bundles = 64;
    kind.settings.groups = 2;
    kind.settings.checkpoints.file = file;
    int calls = 0;
    solve(kind.scene, make_patches(kind.scene), kind.settings,
          [&](const Progress&) { return ++calls < answers; });
    return kind;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
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

// Planted, seen to fail: the settings' hash without the batch; the scene's hash not compared.
TEST_CASE("a checkpoint of another scene, settings or version is refused with both hashes") {
    const Kind kind = stopped_run();
    const Patches patches = make_patches(kind.scene);
    SolveSettings resumed = kind.settings;
    resumed.checkpoints = {};
    resumed.checkpoints.resume = file;

    Scene other = kind.scene;
    other.materials[0].name = "another";
    Scene finer = kind.scene;
    finer.surfaces[0].grid_u = 2;
    for (const Scene& scene : {other, finer}) {
        const Patches own = make_patches(scene);
        const std::string why = refusal(scene, own, resumed);
        CHECK(contains(why, "another scene"));
        CHECK(contains(why, hash_text(scene_hash(kind.scene, patches))));
        CHECK(contains(why, hash_text(scene_hash(scene, own))));
    }
    const std::vector<std::function<void(SolveSettings&)>> changes = {
        [](SolveSettings& s) { s.method = Method::lines, s.batch = 1; },
        [](SolveSettings& s) { s.direction = Direction::oriented; },
        [](SolveSettings& s) { s.first_shot = FirstShot::rays; },
        [](SolveSettings& s) { s.first_shot_rays = 7; },
        [](SolveSettings& s) { s.shots = 1; },
        [](SolveSettings& s) { s.bundles = 65; },
        [](SolveSettings& s) { s.bundles = 0, s.lines = 5000; },
        [](SolveSettings& s) { s.line_spacing = 0.1; },
        [](SolveSettings& s) { s.lines_per_patch = 5; },
        [](SolveSettings& s) { s.batch = 2; },
        [](SolveSettings& s) { s.gather_share = 0.5; },
        [](SolveSettings& s) { s.groups = 4; },
        [](SolveSettings& s) { s.target_error = 0.1; },
        [](SolveSettings& s) { s.directions = DirectionSet::random; },
        [](SolveSettings& s) { s.seed = 2; },
        [](SolveSettings& s) { s.sphere_radius = 3; }};
    for (const auto& change : changes) {
        SolveSettings settings = resumed;
        change(settings);
        const std::string why = refusal(kind.scene, patches, settings);
        CHECK(contains(why, "other settings"));
        CHECK(contains(why, hash_text(settings_hash(kind.settings))));
        CHECK(contains(why, hash_text(settings_hash(settings))));
    }
    // What is no part of the result may change.
    SolveSettings settings = resumed;
    settings.threads = 3, settings.max_memory = std::uint64_t(1) << 40, settings.time_limit = 1e3;
    CHECK(refusal(kind.scene, patches, settings) == "");
    const std::string bytes = bytes_of_file();
    const std::string version = "9.9.9";
    std::string later = bytes;
    later.replace(sealed_head + 8, version.size(), version);
    seal(later);
    write(later);
    CHECK(contains(refusal(kind.scene, patches, resumed), version));
    std::filesystem::remove(file);
}

// Planted, seen to fail: the checksum not compared.
TEST_CASE("a checkpoint with any byte changed, or of any other length, is refused") {
    const Kind kind = stopped_run();
    const std::string whole = bytes_of_file();
    REQUIRE(whole.size() > 500);
    auto refused = [](const std::string& bytes) {
        write(bytes);
        try {
            read_sealed(file, checkpoint_kind);
            return false;
        } catch (const Error& error) {
            return error.fault() == Fault::input;
        }
    };
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << at % 8));
        CAPTURE(at);
        CHECK(refused(bytes));
        CHECK(refused(whole.substr(0, at)));
    }
    CHECK(refused(whole + '\0'));
    CHECK(!refused(whole));
    SolveSettings resumed = kind.settings;
    resumed.checkpoints = {};
    resumed.checkpoints.resume = file;
    for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 50) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(~bytes[at]);
        write(bytes);
        CHECK(refusal(kind.scene, make_patches(kind.scene), resumed) != "");
    }
    std::filesystem::remove(file);
    CHECK(contains(refusal(kind.scene, make_patches(kind.scene), resumed), file));
}

// Planted, seen to crash: the sizes of rows not compared with the patches.
TEST_CASE("a made-up checkpoint with a right checksum is refused or run, nothing else") {
    int ran = 0, not_run = 0;
    for (int answers : {3, 20, 40}) {
        const Kind kind = stopped_run(answers);
        const std::string whole = bytes_of_file();
        const Patches patches = make_patches(kind.scene);
        SolveSettings resumed = kind.settings;
        resumed.checkpoints = {};
        resumed.checkpoints.resume = file;
        Random random(1, static_cast<std::uint64_t>(answers));
        for (int k = 0; k < 400; ++k) {
            std::string bytes = whole;
            // Behind what tells the scene and settings, a byte or a word of it.
            const std::size_t first = sealed_head + 8 + 5 + 16;
            const std::size_t at = first + random.bits() % (bytes.size() - sealed_tail - 8 - first);
            if (k % 2) {
                bytes[at] = static_cast<char>(random.bits());
            } else {
                const std::uint64_t word = random.bits() >> random.bits() % 64;
                std::memcpy(bytes.data() + at, &word, sizeof word);
            }
            seal(bytes);
            write(bytes);
            (refusal(kind.scene, patches, resumed) == "" ? ran : not_run) += 1;
        }
    }
    MESSAGE(ran, " ran, ", not_run, " were refused");
    CHECK(ran > 0);
    CHECK(not_run > 0);
    std::filesystem::remove(file);
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
        CHECK(contains(failure, "/nowhere/at/all.plx"));
        ++failed;
    };
    check_equal(whole, solve(kind.scene, patches, settings));
    CHECK(failed > 0);
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

namespace {

// How many values each row of the fields has, and their sum.
struct Rows {
    std::vector<std::size_t> sizes;
    std::int64_t sum = 0;

    template <class T>
    void operator()(const T& value) {
        sum += static_cast<std::int64_t>(value);
    }
    template <class T, class A>
    void operator()(const std::vector<T, A>& values) {
        sizes.push_back(values.size());
        for (const T& value : values)
            sum += static_cast<std::int64_t>(value);
    }
};

}  // namespace

// Planted, each seen to fail: the lines that lead out not moved; what came in from the sky not
// moved.
TEST_CASE("what the workers hold is collected, all of it") {
    const Regions regions{3, {0, 1, 2}, {1, 1, 1}, {0, 1, 1}, 2};
    Ways ways(regions, 3);
    ways.keep_one_of(1);
    Banks banks(1, 1, 3, 1 << 20);
    for (std::uint32_t worker = 0; worker < 3; ++worker) {
        TilePairs pairs;
        pairs.from = {{worker}, 1};
        pairs.to = {{(worker + 1) % 3}, 1};
        pairs.first = pairs.from;
        ways.keep(pairs, 0, worker);
        banks.receive(worker, 0, 100);
        banks.totals(worker).sky[0] = 10;
        banks.totals(worker).escaped[0] = 10;
        banks.totals(worker).counts.hits = 1;
    }
    ways.collect();
    Rows kept, held;
    ways.fields(kept);
    CHECK(kept.sizes == std::vector<std::size_t>{3, 3});
    banks.collect(1);
    banks.fields(held);
    CHECK(held.sum == 363);
}

TEST_CASE("methods without checkpoints refuse them") {
    const Scene scene = room(grey(0.5, 1), 1);
    for (Method method : {Method::lines, Method::particles, Method::progressive, Method::matrix}) {
        SolveSettings settings;
        settings.method = method;
        settings.lines = 1000;
        settings.checkpoints.file = file;
        CHECK_THROWS_WITH_AS(solve(scene, make_patches(scene), settings),
                             "--checkpoint and --resume need --method bundles, or lines with "
                             "--batch",
                             Error);
    }
}
