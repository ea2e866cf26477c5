#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "parallux/error.h"
#include "parallux/thermal.h"
#include "reference/exact_factors.h"
#include "support/hand_made.h"
#include "support/statistics.h"

using namespace parallux;
using namespace parallux::test;

namespace {

/// A file that is gone afterwards.
class TextFile {
public:
    explicit TextFile(const std::string& text) {
        std::string pattern = (std::filesystem::temp_directory_path() / "parallux-XXXXXX").string();
        close(mkstemp(pattern.data()));
        path = pattern;
        std::ofstream(path, std::ios::binary) << text;
    }
    ~TextFile() { std::filesystem::remove(path); }
    std::filesystem::path path;
};

constexpr const char* header = "kind,name,temperature\n";

/// A box of unequal sides with six emissivities, faces named face 0 … face 5, n × n cells each.
Scene box(std::uint32_t n) {
    const double reflectance[6] = {0.1, 0.5, 0.2, 0.7, 0.05, 0.3};
    std::array<Material, 6> faces;
    for (int k = 0; k < 6; ++k) {
        faces[k] = grey(reflectance[k]);
        faces[k].name = "face " + std::to_string(k);
    }
    return room(faces, n, glm::dvec3(0), glm::dvec3(1.5, 1, 0.75));
}

Fluxes fluxes_of(Scene& scene, const std::string& temperatures, FluxUnit unit,
                 SolveSettings settings, double sky = 0) {
    const TextFile file(header + temperatures);
    const Temperatures given(file.path);
    given.apply(scene, sky);
    Patches patches = make_patches(scene);
    given.apply(patches);
    FluxMeter meter(scene, patches, unit);
    return meter.fluxes(solve(scene, patches, settings, {}, meter.preview()));
}

SolveSettings bundles(std::uint64_t count) {
    SolveSettings settings;
    settings.first_shot = FirstShot::off;
    settings.bundles = count;
    return settings;
}

}  // namespace

TEST_CASE("in a box of six temperatures the faces' net fluxes are the dense solution's to 0.1 %") {
    // The dense solution has exact form factors. Fails (planted, seen) when E is σ T⁴ without ε,
    // or q is J - ε H.
    Scene scene = box(4);
    const Fluxes fluxes = fluxes_of(scene,
                                    "all,,300\nmaterial,face 0,350\nmaterial,face 1,280\n"
                                    "surface,5,400\nmaterial,face 3,310\n",
                                    FluxUnit::surface, bundles(16384));
    Patches patches = make_patches(scene);
    const double kelvin[6] = {350, 280, 300, 310, 300, 400};
    for (std::size_t patch = 0; patch < patches.count(); ++patch)
        patches.emission[patch] = static_cast<float>((1 - double(patches.reflectance[patch])) *
                                                     black_body(kelvin[patch / 16]));
    const Eigen::MatrixXd factors = exact_factors(scene, patches);
    const Eigen::VectorXd incoming = factors * exact_radiosity(factors, patches);
    double net[6] = {}, area[6] = {}, largest = 0, sum = 0, square = 0;
    for (std::size_t patch = 0; patch < patches.count(); ++patch) {
        const std::size_t face = patch / 16;
        const double absorbs = 1 - double(patches.reflectance[patch]);
        net[face] += patches.area[patch] *
                     (patches.emission[patch] - absorbs * incoming[Eigen::Index(patch)]);
        area[face] += patches.area[patch];
    }
    for (double watts : net)
        largest = std::max(largest, std::fabs(watts));
    REQUIRE(fluxes.rows.size() == 6);
    CHECK(fluxes.closed);
    for (std::size_t face = 0; face < 6; ++face) {
        const Flux& row = fluxes.rows[face];
        const double watts = row.net * row.area;
        MESSAGE("face ", face, ": ", watts, " W, dense ", net[face], ", stderr ",
                row.net_stderr * row.area);
        CHECK(row.area == doctest::Approx(area[face]));
        CHECK(std::fabs(watts - net[face]) < 1e-3 * largest);
        CHECK(row.net == doctest::Approx(row.outgoing - row.incoming));
        square += std::pow((watts - net[face]) / (row.net_stderr * row.area), 2);
        sum += watts;
    }
    // Six t of seven degrees of freedom, nearly five of them free: their squares have mean 7/5 and
    // sum to less than 40 in all but about 1 of 1000 cases; to more than 0.1 in all but as few.
    CHECK(square < 40);
    CHECK(square > 0.1);
    CHECK(std::fabs(sum) < 1e-9 * largest);
    CHECK(fluxes.leaving == 0);
    CHECK(std::fabs(fluxes.imbalance) < 5 * fluxes.leaving_stderr);
}

TEST_CASE("two parallel walls, nearly touching: the closed form of infinite ones") {
    // q = σ (T1⁴ - T2⁴) / (1/ε1 + 1/ε2 - 1). The sides of the gap, which take a thousandth of what
    // meets them, are 4·10⁻⁴ of the area, and send half of it back: less than 2·10⁻⁴ of q.
    std::array<Material, 6> faces;
    faces.fill(grey(0.999));
    faces[4] = grey(0.2);
    faces[5] = grey(0.4);
    for (int k = 0; k < 6; ++k)
        faces[k].name = "face " + std::to_string(k);
    Scene scene = room(faces, 1, glm::dvec3(0), glm::dvec3(1, 1, 0.0001));
    const Fluxes fluxes = fluxes_of(scene, "all,,0\nmaterial,face 4,400\nmaterial,face 5,300\n",
                                    FluxUnit::surface, bundles(4096));
    const double expected = (black_body(400) - black_body(300)) / (1 / 0.8 + 1 / 0.6 - 1);
    for (std::size_t face : {4u, 5u})
        MESSAGE(fluxes.rows[face].net, " W/m², expected ", expected);
    CHECK(fluxes.rows[4].net == doctest::Approx(expected).epsilon(1e-3));
    CHECK(fluxes.rows[5].net == doctest::Approx(-expected).epsilon(1e-3));
}

TEST_CASE("at one temperature nothing flows, closed or under a sky as warm") {
    // Each patch within its own error, of eight groups. Fails (planted, seen) when the sky's
    // radiance is σ T⁴ without 1/π.
    for (bool open : {false, true}) {
        Scene scene = box(3);
        if (open)
            scene.surfaces.pop_back();
        const Fluxes fluxes = fluxes_of(scene, "all,,300\n", FluxUnit::patch, bundles(4096), 300);
        CHECK(fluxes.closed == !open);
        double worst = 0, error = 0;
        for (const Flux& row : fluxes.rows) {
            worst = std::max(worst, std::fabs(row.net) / row.net_stderr);
            error = std::max(error, row.net_stderr);
        }
        MESSAGE("largest net flux in its errors: ", worst, ", largest error: ", error, " W/m²");
        CHECK(worst < sidak_bound(fluxes.rows.size(), 8));
        CHECK(error < 0.01 * black_body(300));
    }
}

TEST_CASE("a black plate under a black sky: q = σ (T⁴ - T_sky⁴)") {
    Scene scene = room(grey(0), 2);
    scene.surfaces.resize(1);
    const Fluxes fluxes = fluxes_of(scene, "all,,300\n", FluxUnit::object, bundles(1024), 250);
    REQUIRE(fluxes.rows.size() == 1);
    CHECK(!fluxes.closed);
    CHECK(fluxes.rows[0].net == doctest::Approx(black_body(300) - black_body(250)).epsilon(1e-6));
    CHECK(fluxes.leaving == doctest::Approx(fluxes.rows[0].net * fluxes.rows[0].area));
}

TEST_CASE("what is more specific counts, and what fits nothing is refused with its line") {
    Scene scene = box(1);
    const TextFile file(std::string(header) +
                        "patch,2,320\nsurface,1,310\nmaterial,face *,305\nall,,300\n");
    const Temperatures given(file.path);
    given.apply(scene, 0);
    Patches patches = make_patches(scene);
    given.apply(patches);
    const double expected[6] = {305, 310, 320, 305, 305, 305};
    for (std::size_t k = 0; k < 6; ++k)
        CHECK(patches.emission[k] ==
              doctest::Approx((1 - double(patches.reflectance[k])) * black_body(expected[k])));
    for (const char* rows :
         {"material,nobody,300\n", "surface,6,300\n", "surface,x,300\n", "object,box 0,-1\n",
          "all,,nan\n", "all,,1e9\n", "colour,red,300\n", "material,face 0,300\n", "all,300\n"}) {
        CAPTURE(std::string(rows));
        Scene again = box(1);
        const TextFile bad(header + std::string(rows));
        try {
            Temperatures(bad.path).apply(again, 0);
            FAIL("not refused");
        } catch (const Error& error) {
            CHECK(error.fault() == Fault::input);
            CHECK(std::string(error.what()).find(bad.path.string()) == 0);
        }
    }
}
