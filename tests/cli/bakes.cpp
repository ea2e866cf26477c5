#include <doctest/doctest.h>

#include <array>
#include <filesystem>

#include "cli/run.h"

// Bakes from the command line. Cases name the planted errors that were seen to fail them.

namespace {

std::vector<std::string> solve(const Workplace& place, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"solve",     place.scene(), "--patches", "60",
                                          "--bundles", "64",          "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

}  // namespace

TEST_CASE("equal runs leave equal bakes, whatever the threads") {
    Workplace place;
    std::vector<std::string> names = {"b.glb", "b.gltf", "b.ply", "map.exr", "map.glb"};
    std::vector<std::string> first;
    for (std::string threads : {"1", "3"}) {
        Outcome outcome =
            run(place, solve(place, {"--threads", threads, "--bake", place / "b.glb", "--bake",
                                     place / "b.gltf", "--bake", place / "b.ply", "--lightmap",
                                     place / "map.exr"}));
        CAPTURE(outcome.err);
        REQUIRE(outcome.code == 0);
        CHECK(outcome.out + outcome.err == "");
        CHECK(place.files() == names);
        for (std::size_t i = 0; i < names.size(); ++i) {
            std::string bytes = read_file(place / names[i]);
            CHECK(bytes.size() > 100);
            if (first.size() < names.size())
                first.push_back(bytes);
            else
                CHECK(bytes == first[i]);
        }
    }
}

// Planted: the lightmap's mesh not among the outputs that are checked before the solve.
TEST_CASE("bakes that cannot be written are refused before the solve with code 4") {
    Workplace place;
    write_file(place / "file", "");
    std::filesystem::create_directory(place / "folder.glb");
    std::filesystem::create_directory(place / "map.glb");
    std::vector<std::array<std::string, 3>> cases = {
        {"--bake", place / "missing/b.glb", place / "missing/b.glb"},
        {"--bake", place / "file/b.ply", place / "file/b.ply"},
        {"--bake", place / "folder.glb", place / "folder.glb"},
        {"--lightmap", place / "missing/m.exr", place / "missing/m.exr"},
        {"--lightmap", place / "map.exr", place / "map.glb"}};
    for (const auto& [option, target, named] : cases) {
        Outcome outcome =
            run(place, {"solve", place.scene(), "--bundles", "100000000", option, target});
        CAPTURE(outcome.err);
        CHECK(outcome.code == 4);
        CHECK(outcome.one_line(named));
    }
    CHECK(place.files() == std::vector<std::string>{"file", "folder.glb", "map.glb"});
}

TEST_CASE("an older bake stays whole when a run fails") {
    Workplace place;
    for (std::string name : {"b.glb", "m.exr", "m.glb"})
        write_file(place / name, "older");
    auto outputs = [&](const std::string& limit) {
        return solve(place, {"--bake", place / "b.glb", "--lightmap", place / "m.exr",
                             "--max-memory", limit});
    };
    CHECK(run(place, outputs("1K")).code == 5);
    for (std::string name : {"b.glb", "m.exr", "m.glb"})
        CHECK(read_file(place / name) == "older");
    CHECK(run(place, outputs("4G")).code == 0);
    for (std::string name : {"b.glb", "m.exr", "m.glb"})
        CHECK(read_file(place / name) != "older");
}

// Nothing was planted here.
TEST_CASE("a lightmap for each object is checked before the solve, written, and told") {
    Workplace place;
    REQUIRE(run(place, solve(place, {"--lightmap", place / "scene.exr"})).code == 0);
    auto arguments = [&](const std::string& bundles) {
        return std::vector<std::string>{
            "solve",      place / "scene.glb", "--bundles",     bundles,   "--progress",      "off",
            "--lightmap", place / "m.exr",     "--lightmap-uv", "objects", "--lightmap-size", "64",
            "--save",     place / "r.plx"};
    };
    Outcome outcome = run(place, arguments("32"));
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    std::string picture;
    for (const std::string& name : place.files())
        if (name.starts_with("m_"))
            picture = name;
    REQUIRE(picture != "");
    CHECK(place.files() ==
          std::vector<std::string>{"m.glb", picture, "r.plx", "scene.exr", "scene.glb"});
    CHECK(outcome.out.find(place / picture) != std::string::npos);
    // From the result, which knows that these coordinates were read.
    const std::string bytes = read_file(place / picture);
    CHECK(run(place, {"bake", place / "r.plx", place / "scene.glb", "--lightmap", place / "m.exr",
                      "--lightmap-uv", "objects", "--lightmap-size", "64", "--quiet"})
              .code == 0);
    CHECK(read_file(place / picture) == bytes);
    CHECK(run(place, {"bake", place / "r.plx", place / "scene.glb", "--lightmap", place / "n.exr",
                      "--quiet"})
              .code == 0);
    std::filesystem::remove(place / picture);
    std::filesystem::create_directory(place / picture);
    outcome = run(place, arguments("100000000"));
    CHECK(outcome.code == 4);
    CHECK(outcome.one_line(picture));
}

// Planted: the lightmap's mesh not among the outputs.
TEST_CASE("bake options that make no sense are refused with code 2") {
    Workplace place;
    for (std::vector<std::string> options :
         {std::vector<std::string>{"--bake", "b.obj"},
          {"--bake", place / "b.glb", "--quantity", "lumen"},
          {"--bake", place / "b.glb", "--bake-mesh", "fine"},
          {"--bake", place / "m.glb", "--lightmap", place / "m.exr"},
          {"--lightmap", place / "m.png"},
          {"--lightmap", place / "m.exr", "--lightmap-size", "3"},
          {"--lightmap", place / "m.exr", "--unlit"},
          {"--quantity", "irradiance"},
          {"--flat"},
          {"--exposure", "1", "--bake", place / "b.glb"}}) {
        Outcome outcome = run(place, solve(place, options));
        CAPTURE(options[0]);
        CAPTURE(outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.one_line(""));
    }
    CHECK(place.files().empty());
}
