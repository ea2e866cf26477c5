#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "hand_made.h"
#include "parallux/error.h"
#include "parallux/picture.h"

using namespace parallux;
using hand_made::Case;
using hand_made::dvec3;

namespace {

// Looks along -z from z = 4 upon the square [-1, 1]² and beyond.
Camera from_above() {
    Camera camera;
    camera.position = {0, 0, 4};
    camera.vertical_fov = 2 * std::atan(0.5);
    return camera;
}

PictureSettings small(std::uint32_t width = 40) {
    PictureSettings settings;
    settings.width = settings.height = width;
    settings.threads = 2;
    return settings;
}

Picture shoot(const Case& c, const Camera& camera, const PictureSettings& settings) {
    return render(c.scene, c.patches, c.solution, camera, settings);
}

}  // namespace

// Planted errors: the division by π left out or done twice; emission forgotten; rows upside down
// (the brighter half is that of larger y, at the top); the horizontal axis mirrored.
TEST_CASE("radiance is (E + ρ H) / π at the point, the right way up") {
    Case c;
    Spectrum rho = Spectrum::constant(0.5f), emission;
    rho[1] = 0.25f, emission[2] = 7;
    c.material(rho, false, emission);
    c.quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 32, 32);
    auto linear = [](const dvec3& p, const dvec3&) { return 20 + 2 * p.x + 3 * p.y; };
    c.divide(linear);
    Camera camera = from_above();
    camera.orthographic_height = 4;
    Picture picture = shoot(c, camera, small());
    for (std::uint32_t y = 0; y < 40; ++y)
        for (std::uint32_t x = 0; x < 40; ++x) {
            std::size_t i = y * 40 + x;
            double h = linear({-2 + 4 * (x + 0.5) / 40, 2 - 4 * (y + 0.5) / 40, 0}, {});
            // The samples' mean place is off by up to a fraction of a pixel.
            CHECK(picture.radiance[3 * i] == doctest::Approx(0.5 * h / pi).epsilon(0.01));
            CHECK(picture.radiance[3 * i + 1] == doctest::Approx(0.25 * h / pi).epsilon(0.01));
            CHECK(picture.radiance[3 * i + 2] == doctest::Approx((7 + 0.5 * h) / pi).epsilon(0.01));
            CHECK(picture.irradiance[3 * i] == doctest::Approx(h).epsilon(0.01));
            CHECK(picture.albedo[3 * i + 1] == doctest::Approx(0.25));
            CHECK(picture.normal[3 * i + 2] == doctest::Approx(1));
            CHECK(picture.alpha[i] == 1);
        }
}

// Planted error: the field of view taken as the horizontal or the half angle.
TEST_CASE("the vertical field of view spans the picture's height") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-1, -2, 0}, {2, 0, 0}, {0, 4, 0}, 2, 2);  // 4 high at distance 4: the whole height
    c.divide([](const dvec3&, const dvec3&) { return 1.0; });
    PictureSettings settings = small(80);
    settings.height = 40;
    Picture picture = shoot(c, from_above(), settings);
    double covered = 0;
    for (float a : picture.alpha)
        covered += a;
    CHECK(covered == doctest::Approx(20 * 40).epsilon(0.03));
    CHECK(picture.alpha[2 * 80 + 40] == 1);
    CHECK(picture.alpha[20 * 80 + 25] == 0);
    CHECK(picture.patch[20 * 80 + 25] == -1);
}

// Planted errors: culling that stops at the first back or at two in a row; a two-sided back that
// shows its front's patch.
TEST_CASE("backs of one-sided surfaces are seen through, two-sided ones show their own patch") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.material(Spectrum::constant(0.5f), true);
    for (double z : {2.0, 1.5, 1.5, 1.0})
        c.quad({-4, -4, z}, {0, 8, 0}, {8, 0, 0}, 1, 1);  // fronts look down
    c.quad({-4, -4, 0}, {0, 8, 0}, {8, 0, 0}, 1, 1, 1);
    c.divide([](const dvec3&, const dvec3& n) { return n.z > 0 ? 6.0 : 2.0; });
    Picture picture = shoot(c, from_above(), small(8));
    for (std::size_t i = 0; i < 64; ++i) {
        CHECK(picture.patch[i] == c.patches.grids[4].back);
        CHECK(picture.radiance[3 * i] == doctest::Approx(3 / pi));
        CHECK(picture.normal[3 * i + 2] == doctest::Approx(1));
    }
}

// Planted error: sky radiance divided by π, or alpha 1 for it.
TEST_CASE("rays that escape show the sky with alpha 0, black where it is dark") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({10, 10, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1);
    c.divide([](const dvec3&, const dvec3&) { return 1.0; });
    Picture dark = shoot(c, from_above(), small(4));
    c.scene.sky.kind = Sky::Kind::uniform;
    c.scene.sky.zenith = Spectrum::constant(5);
    Picture lit = shoot(c, from_above(), small(4));
    for (std::size_t i = 0; i < 16; ++i) {
        CHECK(dark.radiance[3 * i] == 0);
        CHECK(lit.radiance[3 * i] == 5);
        CHECK(lit.alpha[i] == 0);
    }
}

// Planted error: flat pictures that use the interpolated field.
TEST_CASE("a flat picture is B / π of each patch") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 2, 2);
    c.divide([](const dvec3& p, const dvec3&) { return p.x > 0 ? 1.0 : 3.0; });
    PictureSettings settings = small();
    settings.flat = true;
    Picture picture = shoot(c, from_above(), settings);
    for (std::size_t i = 0; i < 1600; ++i)
        if (i % 40 < 19 || i % 40 > 20)
            CHECK(picture.radiance[3 * i] == doctest::Approx((i % 40 < 20 ? 1.5 : 0.5) / pi));
}

// Planted, each seen to fail: the error divided by π as radiance is; divided by the samples that
// met a surface, not by all.
TEST_CASE("the error layer is the standard error of the patches seen, unsmoothed") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-1, -2, 0}, {2, 0, 0}, {0, 4, 0}, 2, 1);  // the middle half of the picture's width
    c.divide([](const dvec3& p, const dvec3&) { return 4 + p.x; });
    Camera camera = from_above();
    camera.orthographic_height = 4;
    CHECK(shoot(c, camera, small()).stderror.empty());

    // The same everywhere: as many times that as there is surface in the pixel.
    c.solution.stderror.assign(c.solution.radiosity.size(), 0.25f);
    Picture picture = shoot(c, camera, small());
    for (std::size_t i = 0; i < 1600; ++i)
        for (std::size_t b = 0; b < 3; ++b)
            CHECK(picture.stderror[3 * i + b] == doctest::Approx(0.25 * picture.alpha[i]));
    CHECK(picture.alpha[820] == 1);
    CHECK(picture.alpha[805] == 0);

    // Left and right, each band its own: a step, where irradiance goes up in a line.
    for (std::size_t k = 0; k < 6; ++k)
        c.solution.stderror[k] = static_cast<float>(k + 1);
    const double left[] = {1, 2, 3}, right[] = {4, 5, 6};
    picture = shoot(c, camera, small());
    for (std::size_t i = 0; i < 1600; ++i) {
        const std::size_t x = i % 40;
        for (std::size_t b = 0; b < 3; ++b)
            if ((x > 10 && x < 19) || (x > 20 && x < 29))
                CHECK(picture.stderror[3 * i + b] ==
                      doctest::Approx((x < 20 ? left : right)[b] * picture.alpha[i]));
    }
    CHECK(picture.irradiance[3 * 817] < picture.irradiance[3 * 818]);
}

// Planted error: samples that take their numbers from the worker and not from the pixel.
TEST_CASE("equal pictures on any number of threads") {
    Case c;
    c.scene.bands = 2;
    c.material(Spectrum::constant(0.5f));
    c.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 9, 9);
    c.box({-0.5, -0.5, 0}, {1, 0.7, 1}, 3);
    c.divide([](const dvec3& p, const dvec3& n) { return 3 + p.x * p.y + n.x; });
    PictureSettings settings = small();
    settings.threads = 1;
    Picture one = shoot(c, from_above(), settings);
    for (unsigned threads : {2u, 7u}) {
        settings.threads = threads;
        Picture many = shoot(c, from_above(), settings);
        CHECK(one.radiance == many.radiance);
        CHECK(one.display == many.display);
        CHECK(one.irradiance == many.irradiance);
        CHECK(one.normal == many.normal);
        CHECK(one.patch == many.patch);
    }
}

// Planted error: the check of finiteness left out.
TEST_CASE("a solution with NaN is an internal fault, not a black pixel") {
    Case c;
    c.material(Spectrum::constant(0.5f));
    c.quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, 2, 2);
    c.divide([](const dvec3&, const dvec3&) { return std::numeric_limits<double>::quiet_NaN(); });
    PictureSettings settings = small(4);
    settings.flat = true;
    for (bool flat : {true, false}) {
        settings.flat = flat;
        try {
            shoot(c, from_above(), settings);
            FAIL("no fault");
        } catch (const Error& error) {
            CHECK(error.fault() == Fault::internal);
        }
    }
}
