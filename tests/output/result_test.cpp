#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include <doctest/doctest.h>

#include "glb.h"
#include "output/checksum.h"
#include "output/result_fields.h"
#include "parallux/parallux.h"

// Results in files. Cases name the planted errors that were seen to fail them.

using namespace parallux;

namespace {

const std::string file =
    (std::filesystem::temp_directory_path() / "parallux_result_test.plx").string();

void write(const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

SavedSolution small() {
    SavedSolution r{"1.2", 77, {"--sky", "uniform:1"}, {}, {}};
    r.settings.method = Method::lines, r.settings.seed = 9, r.settings.target_error = 0.5;
    Solution& s = r.solution;
    s.bands = 2;
    s.irradiance = {1, 2, 3, 4}, s.radiosity = {5, 6, 7, 8}, s.stderror = {0.5f, 0.25f, 0, 1};
    s.hash = 3, s.energy = {0.125, {9, 8}, {7, 6}, {5, 4}, {3, 2}, {0, 0}};
    s.counts = {100, 90, 80, 70, 1, 2};
    s.leaks = 4, s.seconds = {1, 2, 3, 4, 5, 6, 7, 8};
    s.relative_rms = 0.01, s.relative_rms_bound = 0.02, s.groups = 8, s.bundles = 800;
    s.line_spacing = 0.1, s.batch = 3, s.threads = 2, s.first_shot_rays = 5, s.shots = 6;
    s.partial = true, s.warnings = {"w", ""};
    return r;
}

// "", or why the file is refused: anything but Fault::input is thrown on.
std::string refusal() {
    try {
        read_result(file);
        return "";
    } catch (const Error& error) {
        if (error.fault() != Fault::input)
            throw;
        return error.what();
    }
}

// The bytes with the checksum and length that they should have.
std::string sealed(std::string bytes) {
    const std::uint64_t size = bytes.size();
    std::memcpy(bytes.data() + 12, &size, 8);
    Checksum sum;
    sum.add(std::string_view(bytes).substr(0, size - 8));
    const std::uint64_t value = sum.value();
    std::memcpy(bytes.data() + size - 8, &value, 8);
    return bytes;
}

// Each value as text, in the file's order.
struct Listing {
    std::vector<std::string> texts;
    void operator()(const std::string& text) { texts.push_back(text); }
    void operator()(const Method& method) { texts.push_back(method_name(method)); }
    template <class T>
    void operator()(const T& value) {
        texts.push_back(std::to_string(value));
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        for (const T& value : values)
            (*this)(value);
        texts.push_back("end");
    }
};

Scene plate() {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    Surface surface;
    surface.corner = {0, 1, 2, 3};
    scene.surfaces = {surface};
    scene.materials.emplace_back();
    scene.objects = {"plate"};
    return scene;
}

}  // namespace

// Planted: stderror not among the fields; two counts swapped in reading alone.
TEST_CASE("what is written is read back, every value of it") {
    SavedSolution result = small();
    write_result(file, result);
    SavedSolution read = read_result(file);
    Listing wanted, got;
    result_fields(wanted, result), result_fields(got, read);
    CHECK(wanted.texts == got.texts);
    const Solution& s = read.solution;
    CHECK(s.irradiance == small().solution.irradiance);
    CHECK(s.radiosity == small().solution.radiosity);
    CHECK(s.stderror == small().solution.stderror);
    CHECK(s.counts.met_backs == 2);
    CHECK(s.counts.transfers == 70);
    CHECK(s.seconds.serial == 8);
    CHECK(s.energy.escaped == small().solution.energy.escaped);
    CHECK(s.warnings == small().solution.warnings);
    CHECK(s.partial);
    CHECK(read.settings.method == Method::lines);
    CHECK(read.arguments == small().arguments);
}

// Planted: the checksum not compared; of the file's last word only the lower half compared.
TEST_CASE("every byte that is changed, and every length that is cut, is refused") {
    write_result(file, small());
    const std::string whole = test::bytes_of(file);
    REQUIRE(whole.size() < 2000);
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (int flip : {0x01, 0x80, 0xff}) {
            std::string bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ flip);
            write(bytes);
            CAPTURE(at);
            CHECK(refusal() != "");
        }
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write(whole.substr(0, length));
        CAPTURE(length);
        CHECK(refusal() != "");
    }
    write(whole + '\0');
    CHECK(refusal() != "");
    write(whole);
    CHECK(refusal() == "");
}

// Planted: a count that is not compared with the bytes there are.
TEST_CASE("a made-up file with the right checksum is read or refused, no more") {
    write_result(file, small());
    const std::string whole = test::bytes_of(file);
    std::size_t refused = 0;
    for (std::size_t at = sealed_head; at + 8 < whole.size(); ++at)
        for (int flip : {0x01, 0x7f, 0xff}) {
            std::string bytes = whole;
            bytes[at] = static_cast<char>(bytes[at] ^ flip);
            write(sealed(bytes));
            refused += refusal() != "";
        }
    CHECK(refused > 100);
    for (std::size_t length = sealed_head + 8; length < whole.size(); ++length) {
        write(sealed(whole.substr(0, length)));
        CAPTURE(length);
        CHECK(refusal() != "");
    }
    for (float value : {HUGE_VALF, NAN}) {
        SavedSolution odd = small();
        odd.solution.radiosity[2] = value;
        write_result(file, odd);
        CHECK(refusal().find("finite") != std::string::npos);
    }
}

// Planted: the format's number not compared.
TEST_CASE("a result of another format names both") {
    write_result(file, small());
    std::string bytes = test::bytes_of(file);
    bytes[8] = 2;
    write(sealed(bytes));
    CHECK(refusal().find("format 2, this version reads format 1") != std::string::npos);
    write("PLXRES\n\n" + bytes.substr(8));
    CHECK(refusal().find("not a result") != std::string::npos);
}

// Planted: attributes' colours, or the sky's image, not among what is hashed.
TEST_CASE("the scene's hash tells all that outputs need, and not the cameras") {
    const Scene scene = plate();
    const Patches patches = make_patches(scene, {.count = 4});
    const std::uint64_t hash = scene_hash(scene, patches);
    using Change = std::function<void(Scene&)>;
    const std::vector<Change> changes = {
        [](Scene& s) { s.positions[1].x = std::nextafter(1.0, 2.0); },
        [](Scene& s) { s.materials[0].name = "other"; },
        [](Scene& s) { s.materials[0].two_sided = true; },
        [](Scene& s) { s.materials[0].reflectance[2] = 0.5f; },
        [](Scene& s) { s.materials[0].emission_uv = 1; },
        [](Scene& s) { s.objects[0] = "other"; },
        [](Scene& s) { s.surfaces[0].grid_u = 2; },
        [](Scene& s) { s.attributes.emplace_back(); },
        [](Scene& s) { s.lights.emplace_back(); },
        [](Scene& s) { s.sky.kind = Sky::Kind::uniform; },
        [](Scene& s) { s.sky.zenith[7] = 1; },
        [](Scene& s) { s.sky.shape.offset = 1; },
        [](Scene& s) { s.sky.image.texels.emplace_back(1); },
        [](Scene& s) { s.period[1].y = 3; },
        [](Scene& s) { s.bands = 1; }};
    std::vector<std::uint64_t> seen = {hash};
    for (std::size_t i = 0; i < changes.size(); ++i) {
        Scene other = scene;
        changes[i](other);
        CAPTURE(i);
        seen.push_back(scene_hash(other, patches));
        CHECK(std::count(seen.begin(), seen.end(), seen.back()) == 1);
    }
    Scene coloured = scene;
    coloured.attributes.emplace_back();
    const std::uint64_t white = scene_hash(coloured, patches);
    coloured.attributes[0].colour[2].y = 0.5f;
    CHECK(scene_hash(coloured, patches) != white);
    Patches other = patches;
    other.emission[0] = 1;
    CHECK(scene_hash(scene, other) != hash);
    CHECK(scene_hash(scene, make_patches(scene, {.count = 9})) != hash);
    Scene seen_anew = scene;
    seen_anew.cameras.emplace_back(), seen_anew.file = "new.gltf";
    CHECK(scene_hash(seen_anew, patches) == hash);
}
