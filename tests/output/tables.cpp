#include <doctest/doctest.h>

#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "output/table_reader.h"
#include "parallux/error.h"
#include "parallux/tables.h"

// Tables written, read and compared. Each case names the planted error that makes it fail.

using namespace parallux;
namespace fs = std::filesystem;

namespace {

/// A file that is gone afterwards.
struct File {
    explicit File(const char* name) : path(fs::temp_directory_path() / unique(name)) {}
    ~File() { fs::remove(path); }
    static std::string unique(const char* name) {
        return "parallux-" + std::to_string(getpid()) + "-" + name;
    }
    std::string text() const {
        std::ostringstream all;
        all << std::ifstream(path).rdbuf();
        return all.str();
    }
    void fill(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }

    fs::path path;
};

/// A two-sided unit square, 2 × 1 cells, in a scene whose names need quoting.
struct Square {
    Scene scene;
    Patches patches;
    Solution solution;

    explicit Square(std::uint32_t bands = 3) {
        scene.file = "square\xff.json";
        scene.bands = bands;
        scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        scene.objects = {"a \"b\", c\nd"};
        scene.materials.resize(1);
        scene.materials[0].name = "plain";
        scene.materials[0].two_sided = true;
        scene.materials[0].reflectance = Spectrum::constant(0.5f);
        scene.surfaces.resize(1);
        scene.surfaces[0].corner = {0, 1, 2, 3};
        scene.surfaces[0].grid_u = 2;
        scene.surfaces[0].grid_v = 1;
        patches = make_patches(scene);
        solution.bands = bands;
        solution.radiosity.assign(patches.count() * bands, 2.0f);
        solution.irradiance.assign(patches.count() * bands, 1.0f / 3);
        solution.energy.watts_per_quantum = 0.5;
        for (auto* part :
             {&solution.energy.emitted, &solution.energy.absorbed, &solution.energy.escaped,
              &solution.energy.unshot, &solution.energy.residual})
            part->assign(bands, 0);
        solution.energy.emitted[0] = 3;
    }
    void write(const File& file) const { write_table(file.path, scene, patches, solution); }
};

/// The message of the Fault::input that reading this text ends with; "" when it is taken.
std::string refusal(const std::string& text) {
    File file("damaged.csv");
    file.fill(text);
    try {
        TableReader reader(file.path);
        while (reader.next()) {
        }
    } catch (const Error& error) {
        CHECK(error.fault() == Fault::input);
        return error.what();
    }
    return "";
}

std::string replaced(std::string text, const std::string& old, const std::string& now) {
    std::size_t at = text.find(old);
    REQUIRE(at != std::string::npos);
    return text.replace(at, old.size(), now);
}

}  // namespace

// Planted: "r, g, b" for one band, or the index from 1.
TEST_CASE("band names") {
    CHECK(band_name(3, 0) + band_name(3, 1) + band_name(3, 2) == "rgb");
    CHECK(band_name(1, 0) == "0");
    CHECK(band_name(8, 7) == "7");
}

// Planted: 6 digits instead of 9; names unquoted; a locale's decimal comma; back listed as front.
TEST_CASE("a table has the promised header, 9 digits and quoted names") {
    Square square(1);
    File file("digits.csv");
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    square.write(file);
    std::setlocale(LC_ALL, "C");
    std::string text = file.text();
    CHECK(
        text.starts_with("patch,surface,name,material,iu,iv,x,y,z,nx,ny,nz,area,side,"
                         "reflectance_0,emission_0,irradiance_0,radiosity_0,stderr_0\n"
                         "0,0,\"a \"\"b\"\", c\nd\",plain,0,0,0.25,0.5,0,0,0,1,0.5,front,"
                         "0.5,0,0.333333343,2,\n"));
    CHECK(text.find(",0,0,-1,0.5,back,") != std::string::npos);
}

// Planted: NaN printed as "nan".
TEST_CASE("a value that is not finite never reaches a file") {
    Square square;
    square.solution.radiosity[4] = std::numeric_limits<float>::quiet_NaN();
    File file("nan.csv");
    file.fill("older");
    CHECK_THROWS_AS(square.write(file), Error);
    CHECK(file.text() == "older");
}

// Planted: unweighted mean; the reference taken from a; the maximum over signed differences.
TEST_CASE("comparison against hand-made numbers") {
    Square a, b;
    // Areas 0.5 each and four patches; one value differs by -1, all of b are 2.
    a.solution.radiosity[7] = 1.0f;
    File file_a("a.csv"), file_b("b.csv");
    a.write(file_a);
    b.write(file_b);
    Comparison same = compare_tables(file_b.path, file_b.path);
    CHECK(same.patches == 4);
    CHECK(same.rms == 0);
    CHECK(same.relative_rms == 0);
    Comparison one = compare_tables(file_a.path, file_b.path);
    CHECK(one.rms == doctest::Approx(std::sqrt(1.0 / 12)));
    CHECK(one.relative_rms == doctest::Approx(std::sqrt(1.0 / 12) / 2));
    CHECK(one.maximum == 1);
    CHECK(one.maximum_patch == 2);

    for (float& value : b.solution.radiosity)
        value = 0;
    b.write(file_b);
    CHECK(std::isinf(compare_tables(file_a.path, file_b.path).relative_rms));
    CHECK(compare_tables(file_b.path, file_b.path).relative_rms == 0);
}

// Planted: areas weighted as if all were equal.
TEST_CASE("comparison weighs by area") {
    Square a, b;
    for (Square* square : {&a, &b})
        square->patches.area = {3, 1, 3, 1};
    for (std::size_t i = 0; i < 3; ++i)
        a.solution.radiosity[i] = 3.0f;
    File file_a("a.csv"), file_b("b.csv");
    a.write(file_a);
    b.write(file_b);
    CHECK(compare_tables(file_a.path, file_b.path).rms == doctest::Approx(std::sqrt(3.0 / 8)));
}

// Planted: rows matched by position alone.
TEST_CASE("tables of different patches, areas, sides or bands are refused") {
    Square square;
    File a("a.csv"), b("b.csv");
    square.write(a);
    auto refused = [&] {
        CHECK_THROWS_AS(compare_tables(a.path, b.path), Error);
        CHECK_THROWS_AS(compare_tables(b.path, a.path), Error);
    };
    Square(1).write(b);
    refused();
    Square larger;
    larger.patches.area[1] = 0.50001;
    larger.write(b);
    refused();
    std::string text = a.text();
    b.fill(replaced(text, "front", "back"));
    refused();
    b.fill(text.substr(0, text.find("3,0,\"a")));
    refused();
}

// Planted: std::stod, which takes "2x", " 2" and "nan"; a row count that is not checked.
TEST_CASE("damage is refused with file and line") {
    Square square(1);
    square.scene.objects[0] = "plain";
    File file("good.csv");
    square.write(file);
    const std::string good = file.text();
    CHECK(refusal(good) == "");
    CHECK(refusal(replaced(good, ",2,\n1,", ",2,\r\n1,")) == "");
    for (const char* bad : {"nan", "inf", "-inf", "1e99", "1e999", "2x", " 2", "0x2", ""}) {
        std::string message = refusal(replaced(good, ",2,\n1,", "," + std::string(bad) + ",\n1,"));
        CAPTURE(bad);
        CHECK(message.find(".csv:2: radiosity_0") != std::string::npos);
    }
    CHECK(refusal(replaced(good, "\n1,", "\n0,")).find(".csv:3:") != std::string::npos);
    CHECK(refusal(replaced(good, "\n1,", "\n1.5,")).find(".csv:3:") != std::string::npos);
    CHECK(refusal(replaced(good, "\n1,", "\n1,1,")).find(".csv:3: 20 columns") !=
          std::string::npos);
    CHECK(refusal(replaced(good, "0.5,front", "-1,front")) != "");
    CHECK(refusal(replaced(good, "front", "top")) != "");
    CHECK(refusal(replaced(good, "radiosity_0", "radiosity_r")) != "");
    CHECK(refusal("") != "");
    CHECK(refusal(std::string(3 << 20, 'x')) != "");
    CHECK(refusal(std::string(3 << 20, ',')) != "");
    CHECK(refusal(good + "\"" + std::string(3 << 20, '\n')) != "");
    CHECK(refusal(good + std::string(100, '\0') + "\n") != "");
}

// Planted: a last line without its end taken for a whole one.
TEST_CASE("a table cut anywhere but between rows is refused") {
    Square square;
    File file("whole.csv");
    square.write(file);
    const std::string text = file.text();
    std::size_t taken = 0;
    for (std::size_t size = 0; size < text.size(); ++size)
        taken += refusal(text.substr(0, size)) == "";
    CHECK(taken == 4);  // after the header and after each row but the last
}

// Planted: any byte that ends in another exception than Fault::input, or in none of a value changed
// beyond range.
TEST_CASE("changed bytes end in a table or in Fault::input") {
    Square square;
    File file("bytes.csv");
    square.write(file);
    const std::string text = file.text();
    for (std::size_t at = 0; at < text.size(); at += 3)
        for (char byte : {'\0', '"', ',', '\n', '\xff', '9', 'e'}) {
            std::string changed = text;
            changed[at] = byte;
            refusal(changed);
        }
    CHECK(true);
}

// Planted: quanta rounded through float; a file name's bytes that break the JSON.
TEST_CASE("statistics are one JSON object, whatever the names") {
    Square square;
    square.solution.counts = {10, 4, 20, 7, 0, 0};
    square.solution.hash = 0xabcdef;
    square.solution.warnings = {"second"};
    square.scene.warnings = {"first"};
    square.solution.energy.absorbed[0] = (std::int64_t{1} << 60) + 1;
    square.solution.seconds.global = 2;
    File file("stats.json");
    write_stats(file.path, square.scene, square.patches, SolveSettings{}, square.solution);
    auto stats = nlohmann::json::parse(file.text());
    CHECK(stats["patches"] == 4);
    CHECK(stats["average_list"] == 2);
    CHECK(stats["average_nonempty_list"] == 5);
    CHECK(stats["lines_per_second"] == 5);
    CHECK(stats["solution_hash"] == "0000000000abcdef");
    CHECK(stats["warnings"] == nlohmann::json({"first", "second"}));
    CHECK(stats["energy"]["emitted"][0] == 1.5);
    CHECK(stats["energy"]["quanta"]["absorbed"][0] == (std::int64_t{1} << 60) + 1);
    CHECK(stats["energy"]["residual"][0].is_number_integer());
    CHECK(stats["peak_memory_bytes"].get<std::uint64_t>() > 1'000'000);
}
