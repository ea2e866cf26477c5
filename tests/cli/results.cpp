#include <doctest/doctest.h>

#include <filesystem>

#include "cli/run.h"

// A solution kept in a file, and outputs made from it. Cases name the planted errors that were seen
// to fail them.

namespace {

using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

// A table of K bands that differ.
std::string materials(int bands) {
    std::string head = "material", wall = "wall", light = "light";
    for (int b = 0; b < bands; ++b) {
        const std::string k = std::to_string(b);
        head += ",reflectance_" + k + ",emission_" + k;
        wall += ",0." + std::to_string(8 - b) + ",0";
        light += ",0.1," + std::to_string(3 + b);
    }
    return head + "\n" + wall + "\n" + light + "\n";
}

const Words names = {"a.png", "a.exr", "a.glb", "a.gltf", "a.ply",
                     "l.exr", "l.glb", "t.csv", "e.csv"};

// All outputs, into a folder.
Words outputs(const Workplace& place, const std::string& folder, const Words& more) {
    std::filesystem::create_directory(place / folder);
    auto in = [&](const std::string& name) { return place / (folder + "/" + name); };
    return joined(
        {"--image", in("a.png"), "--image", in("a.exr"), "--bake", in("a.glb"), "--bake",
         in("a.gltf"), "--bake", in("a.ply"), "--lightmap", in("l.exr"), "--table", in("t.csv"),
         "--sensor-table", in("e.csv"), "--sensors", place / "s.csv", "--quiet"},
        more);
}

void check_equal(const Workplace& place, const std::string& a, const std::string& b) {
    for (const std::string& name : names) {
        CAPTURE(name);
        const std::string bytes = read_file(place / (a + "/" + name));
        CHECK(bytes.size() > 50);
        CHECK(bytes == read_file(place / (b + "/" + name)));
    }
}

// A box with a result beside it, r.plx, and a file that must not change, a.png.
void solve_small(const Workplace& place, const Words& more) {
    write_file(place / "m.csv", materials(3));
    write_file(place / "a.png", "older");
    REQUIRE(run(place, joined({"solve", place.scene(), "--bundles", "32", "--quiet", "--save",
                               place / "r.plx"},
                              more))
                .code == 0);
}

Outcome render(const Workplace& place, const Words& more) {
    return run(place, joined({"render", place / "r.plx", place.scene(), "--image", place / "a.png"},
                             more));
}

}  // namespace

// Planted: standard errors left out of the file; stored arguments not replayed, which was refused.
TEST_CASE("outputs from a result are those of the solve, to the byte") {
    for (int bands : {1, 3, 8})
        for (const char* groups : {"1", "8"}) {
            Workplace place;
            CAPTURE(bands);
            CAPTURE(groups);
            write_file(place / "m.csv", materials(bands));
            write_file(place / "s.csv", "x,y,z,nx,ny,nz\n0.5,0.5,0.5,0,0,1\n");
            const Words look = bands == 8
                                   ? Words{"--band", "5,0,7", "--size", "40x30", "--exposure", "1"}
                                   : Words{"--size", "40x30", "--quantity", "radiance"};
            Outcome solved = run(
                place, joined(joined({"solve", place.scene()}, outputs(place, "a", look)),
                              {"--materials", place / "m.csv", "--scale", "2", "--patch-size",
                               "0.3", "--no-clusters", "--sky", "uniform:2", "--seed", "5",
                               "--bundles", "800", "--groups", groups, "--save", place / "r.plx"}));
            CAPTURE(solved.err);
            REQUIRE(solved.code == 0);
            for (const char* command : {"render", "bake"}) {
                Outcome again = run(place, joined({command, place / "r.plx", place.scene()},
                                                  outputs(place, command, look)));
                CAPTURE(again.err);
                REQUIRE(again.code == 0);
                CHECK(again.out + again.err == "");
                check_equal(place, "a", command);
            }
        }
}

// Planted: only the numbers of patches compared, not the hashes.
TEST_CASE("a result of another scene is refused with both hashes, and nothing is touched") {
    Workplace place;
    solve_small(place, {"--materials", place / "m.csv"});
    auto refused = [&](const Words& more) {
        Outcome outcome = render(place, more);
        CAPTURE(outcome.err);
        CHECK(outcome.code == 3);
        CHECK(outcome.one_line("r.plx: a result of another scene or other patches: it is of "));
        CHECK(outcome.one_line("box.obj now gives "));
        CHECK(read_file(place / "a.png") == "older");
    };
    refused({"--sky", "uniform:1"});
    refused({"--sun", "40,160,600"});
    refused({"--scale", "2"});
    refused({"--exclude", "light"});
    refused({"--periodic", "4,4"});
    // The table that the result names has other values now.
    std::string table = materials(3);
    table.replace(table.find("0.7"), 3, "0.2");
    write_file(place / "m.csv", table);
    refused({});
    // It has moved: it is where the option says.
    write_file(place / "moved.csv", materials(3));
    std::filesystem::remove(place / "m.csv");
    CHECK(render(place, {}).code == 3);
    CHECK(render(place, {"--materials", place / "moved.csv", "--quiet"}).code == 0);
    CHECK(read_file(place / "a.png") != "older");
    // The scene's own file.
    write_file(place / "a.png", "older");
    std::string obj = read_file(place.scene());
    obj.replace(obj.find("v 1 0 0"), 7, "v 2 0 0");
    write_file(place.scene(), obj);
    refused({"--materials", place / "moved.csv"});
}

// Planted: the checksum not compared.
TEST_CASE("damaged results are refused with code 3 and one line") {
    Workplace place;
    solve_small(place, {"--patches", "6"});
    const std::string whole = read_file(place / "r.plx");
    auto refused = [&](const std::string& bytes) {
        write_file(place / "r.plx", bytes);
        Outcome outcome = render(place, {});
        CAPTURE(outcome.err);
        CHECK(outcome.code == 3);
        CHECK(outcome.one_line("r.plx: "));
        CHECK(read_file(place / "a.png") == "older");
    };
    for (std::size_t at = 0; at < whole.size(); at += 37) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
        refused(bytes);
        refused(whole.substr(0, at));
    }
    refused(read_file(place.scene()));
}

// Planted: the result not among the files that are read, so that a table took its place.
TEST_CASE("an output that cannot be, and a result in an output's place, are refused") {
    Workplace place;
    solve_small(place, {});
    CHECK(run(place, {"render", place / "r.plx", place.scene()}).code == 2);
    CHECK(run(place, {"render", place / "r.plx"}).code == 2);
    CHECK(render(place, {"--patches", "7"}).code == 2);
    CHECK(render(place, {"--table", place / "r.plx"}).code == 2);
    CHECK(render(place, {"--table", place / "missing/t.csv"}).code == 4);
    CHECK(run(place, {"solve", place.scene(), "--save", place / "r.txt"}).code == 2);
    CHECK(run(place, {"solve", place.scene(), "--save", place / "missing/r.plx"}).code == 4);
    CHECK(read_file(place / "a.png") == "older");
}
