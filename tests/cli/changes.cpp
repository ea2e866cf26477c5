#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

#include "cli/run.h"

// Bands, materials, names, temperatures and sensors from the command line.

namespace {

Outcome solve(const Workplace& place, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"solve",     place.scene(), "--patches",  "60",
                                          "--bundles", "64",          "--progress", "off"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(place, arguments);
}

std::size_t lines(const std::string& file) {
    const std::string text = read_file(file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Five bands for both materials of the box.
void write_materials(const Workplace& place) {
    write_file(place / "m.csv",
               "material,reflectance_0,reflectance_1,reflectance_2,reflectance_3,reflectance_4,"
               "emission_0,emission_1,emission_2,emission_3,emission_4\n"
               "wall,0.1,0.2,0.3,0.4,0.5,0,0,0,0,0\n"
               "light,0,0,0,0,0,1,2,3,4,5\n");
}

}  // namespace

// Planted, seen: a picture of five bands written as its mean without a word.
TEST_CASE("a mesh in five bands: table, statistics, EXR, and a PNG of chosen ones") {
    Workplace place;
    write_materials(place);
    Outcome outcome =
        solve(place, {"--materials", place / "m.csv", "--table", place / "t.csv", "--stats",
                      place / "s.json", "--image", place / "a.exr", "--size", "8x8"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(read_file(place / "t.csv").find("radiosity_4,stderr_4\n") != std::string::npos);
    auto stats = nlohmann::json::parse(read_file(place / "s.json"));
    CHECK(stats["bands"] == 5);
    CHECK(stats["energy"]["residual"] == nlohmann::json({0, 0, 0, 0, 0}));
    const std::vector<std::string> png = {"--materials",   place / "m.csv", "--image",
                                          place / "a.png", "--size",        "8x8"};
    outcome = solve(place, png);
    CHECK(outcome.code == 2);
    CHECK(outcome.one_line("--band"));
    for (std::string shown : {"4", "4,2,0"}) {
        std::vector<std::string> more = png;
        more.insert(more.end(), {"--band", shown});
        CHECK(solve(place, more).code == 0);
    }
    for (std::string shown : {"5", "1,2", "x", "", "1,2,3,4"}) {
        std::vector<std::string> more = png;
        more.insert(more.end(), {"--band", shown});
        CHECK(solve(place, more).code == 2);
    }
    CHECK(solve(place, {"--materials", place / "m.csv", "--bands", "4"}).code == 2);
    CHECK(solve(place, {"--bands", "5"}).code == 3);  // its colours are for three
    CHECK(solve(place, {"--bands", "9"}).code == 2);
    CHECK(solve(place, {"--materials", place / "none.csv"}).code == 3);
    // What is read must not be written.
    CHECK(solve(place, {"--materials", place / "m.csv", "--table", place / "m.csv"}).code == 2);
}

// Planted, seen: receivers left out of the solve, or excluded surfaces still in it.
TEST_CASE("receivers take rows, exclusion takes surfaces") {
    Workplace place;
    REQUIRE(solve(place, {"--table", place / "all.csv"}).code == 0);
    REQUIRE(solve(place, {"--table", place / "some.csv", "--receivers", "li*"}).code == 0);
    REQUIRE(solve(place, {"--table", place / "less.csv", "--exclude", "light"}).code == 0);
    const std::string all = read_file(place / "all.csv"), some = read_file(place / "some.csv");
    std::istringstream rows(some);
    std::size_t count = 0;
    for (std::string row; std::getline(rows, row); ++count)
        CHECK(all.find(row + "\n") != std::string::npos);
    CHECK(count > 1);
    CHECK(count < lines(place / "all.csv"));
    CHECK(some.find(",wall,") == std::string::npos);
    CHECK(read_file(place / "less.csv").find(",light,") == std::string::npos);
    CHECK(run(place, {"compare", place / "some.csv", place / "some.csv"}).code == 0);
    CHECK(run(place, {"compare", place / "some.csv", place / "all.csv"}).code == 3);
    CHECK(solve(place, {"--exclude", "nobody"}).one_line("nobody"));
    CHECK(solve(place, {"--exclude", "*"}).code == 2);
    CHECK(solve(place, {"--exclude", "wall,"}).code == 2);
    CHECK(solve(place, {"--receivers", "wall"}).code == 2);  // of no table
}

// Planted, seen: exclusion that takes nothing out.
TEST_CASE("bakes and lightmaps of one band and of five, without what is excluded") {
    Workplace place;
    write_materials(place);
    write_file(place / "one.csv", "material,reflectance_0,emission_0\nwall,0.3,0\nlight,0,3\n");
    auto bake = [&](std::string materials, std::vector<std::string> more) {
        more.insert(more.end(), {"--materials", place / materials, "--lightmap", place / "m.exr"});
        for (std::string ending : {"gltf", "ply"})
            more.insert(more.end(), {"--bake", place / ("b." + ending)});
        const Outcome outcome = solve(place, more);
        CAPTURE(outcome.err);
        CHECK(outcome.code == 0);
        CHECK(read_file(place / "m.exr").size() > 100);
        CHECK(read_file(place / "m.glb").size() > 100);
        return read_file(place / "b.gltf") + read_file(place / "b.ply");
    };
    for (std::string materials : {"one.csv", "m.csv"}) {
        const std::string bands = materials == "m.csv" ? "5" : "1";
        const std::string all = bake(materials, {});
        CHECK(all.find("mean of " + bands) != std::string::npos);
        // Receivers are rows of the table, and of nothing else.
        CHECK(bake(materials, {"--table", place / "t.csv", "--receivers", "light"}) == all);
        CHECK(bake(materials, {"--exclude", "light"}).size() < all.size());
    }
    CHECK(solve(place, {"--bake", place / "b.ply", "--receivers", "light"}).one_line("--table"));
}

TEST_CASE("temperatures in, fluxes out") {
    Workplace place;
    write_file(place / "t.csv", "kind,name,temperature\nall,,300\nmaterial,light,400\n");
    Outcome outcome = solve(place, {"--temperatures", place / "t.csv", "--fluxes", place / "f.csv",
                                    "--fluxes-by", "material"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.out.find("fluxes ") != std::string::npos);
    CHECK(
        read_file(place / "f.csv")
            .find(
                "unit,name,area,temperature,emissivity,incoming,outgoing,net,net_stderr,net_watts,"
                "net_watts_stderr\nmaterial,wall,") == 0);
    CHECK(lines(place / "f.csv") == 3);
    const std::vector<std::string> fluxes = {"--fluxes", place / "f.csv"};
    CHECK(solve(place, fluxes).code == 2);
    write_file(place / "t.csv", "kind,name,temperature\nmaterial,light,400\n");
    outcome = solve(place, {"--temperatures", place / "t.csv", "--fluxes", place / "f.csv"});
    CHECK(outcome.code == 3);
    CHECK(outcome.one_line("no temperature"));
    CHECK(solve(place, {"--sky-temperature", "300"}).code == 2);
    CHECK(solve(place, {"--temperatures", place / "t.csv", "--sky", "uniform:1"})
              .one_line("--sky-temperature"));
    CHECK(solve(place, {"--temperatures", place / "t.csv", "--sky-temperature", "-1"}).code == 2);
    CHECK(run(place,
              {"solve", place.scene(), "--target-error", "0.1", "--temperatures", place / "t.csv"})
              .code == 2);
}

TEST_CASE("sensors in, irradiance out") {
    Workplace place;
    write_file(place / "s.csv", "x,y,z,nx,ny,nz,name\n0.5,0.5,0.5,0,0,1,up\n0.5,0.5,0.5,0,0,-2,\n");
    Outcome outcome = solve(place, {"--sensors", place / "s.csv", "--sensor-table", place / "o.csv",
                                    "--sensor-rays", "1024"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::string table = read_file(place / "o.csv");
    CHECK(table.find("sensor,x,y,z,nx,ny,nz,irradiance_r,stderr_r,solution_stderr_r,") == 0);
    CHECK(table.find("\nup,0.5,0.5,0.5,0,0,1,") != std::string::npos);
    CHECK(lines(place / "o.csv") == 3);
    CHECK(solve(place, {"--sensors", place / "s.csv"}).code == 2);
    CHECK(solve(place, {"--sensor-table", place / "o.csv"}).code == 2);
    outcome = solve(place, {"--sensors", place / "s.csv", "--sensor-table", place / "o.csv",
                            "--periodic", "2,2"});
    CHECK(outcome.code == 2);
    CHECK(outcome.one_line("periodic"));
    for (const char* bad :
         {"x,y,z,nx,ny\n0,0,0,0,0\n", "x,y,z,nx,ny,nz\n", "x,y,z,nx,ny,nz\n0,0,0,0,0,0\n",
          "x,y,z,nx,ny,nz\n0,0,inf,0,0,1\n", "x,y,z,nx,ny,nz,colour\n0,0,0,0,0,1,red\n"}) {
        write_file(place / "s.csv", bad);
        outcome = solve(place, {"--sensors", place / "s.csv", "--sensor-table", place / "o.csv"});
        CHECK(outcome.code == 3);
        CHECK(outcome.one_line("s.csv"));
    }
}
