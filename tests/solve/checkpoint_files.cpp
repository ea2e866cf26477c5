#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "output/fields.h"
#include "output/sealed_file.h"
#include "parallux/error.h"
#include "parallux/result.h"
#include "parallux/solve.h"
#include "random.h"
#include "solve/checkpoint.h"
#include "solve/interrupted.h"
#include "support/soak.h"

// What checkpoints hold, and those that are refused. Cases name the planted errors that were seen
// to fail them.

using namespace parallux;
using namespace parallux::test;

namespace {

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

std::string refusal(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    try {
        solve(scene, patches, settings, [](const Progress&) { return false; });
        return "";
    } catch (const Error& error) {
        CHECK(error.fault() == Fault::input);
        return error.what();
    }
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

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
