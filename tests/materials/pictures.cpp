#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "materials/shiny.h"
#include "parallux/picture.h"
#include "reference/path_tracer.h"
#include "support/statistics.h"

using namespace parallux;
using namespace parallux::test;

namespace {

Camera looking(const glm::dvec3& from, const glm::dvec3& to) {
    Camera camera;
    camera.position = from;
    camera.forward = glm::normalize(to - from);
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0, 0, 1)));
    camera.up = glm::cross(right, camera.forward);
    camera.vertical_fov = 0.01;  // one place, nearly
    return camera;
}

// A black room of glowing walls, each with its own light: solved at once, and exactly.
Scene glowing() {
    Scene scene = room({grey(0, 1), grey(0, 2), grey(0, 3), grey(0, 4), grey(0, 5), grey(0, 6)}, 1);
    return scene;
}

Picture shot(const Scene& scene, const Camera& camera, std::uint32_t samples = 16) {
    const Patches patches = make_patches(scene);
    SolveSettings settings;
    settings.bundles = 16;
    const Solution solution = solve(scene, patches, settings);
    PictureSettings picture;
    picture.width = picture.height = 4;
    picture.samples = samples;
    return render(scene, patches, solution, camera, picture);
}

}  // namespace

// Seen in a mirror is what its image shows, dimmed by its reflectance; past a sheet, what lies
// behind and what is mirrored in it.
TEST_CASE("pictures follow mirrors and glass to what emits") {
    Scene scene = glowing();
    // 45° across the middle: from x- one sees z+.
    add_plate(scene, {0.4, 0.3, 0.4}, {0, 0.4, 0}, {0.2, 0, 0.2}, mirror(0.5));
    const Camera camera = looking({0.1, 0.5, 0.5}, {0.5, 0.5, 0.5});
    for (float value : shot(scene, camera).radiance)
        CHECK(value == doctest::Approx(0.5 * 6 / pi));
    scene.materials[6] = emitting(mirror(0.5, 0, 0.4, 0.3), 1);
    // 0.4 · 0.5 of the image, and E + ρ H with what the other 0.6 of the light brings.
    const Picture mixed = shot(scene, camera);
    CHECK(mixed.radiance[0] > (0.2 * 6 + 1 + 0.6 * 0.3 * 1.5) / pi);
    CHECK(mixed.radiance[0] < (0.2 * 6 + 1 + 0.6 * 0.3 * 6) / pi);
    scene.materials[6] = glass(1.5, 0, true);
    const Picture sheet = shot(scene, camera, 4096);
    // At 45° one polarisation is reflected by the square of the other.
    const double beyond = std::asin(std::sqrt(0.5) / 1.5);
    const double across = std::pow(std::sin(pi / 4 - beyond) / std::sin(pi / 4 + beyond), 2);
    const double face = (across + across * across) / 2, faces = 2 * face / (1 + face);
    CHECK(sheet.radiance[0] == doctest::Approx((faces * 6 + (1 - faces) * 2) / pi).epsilon(0.01));
}

// A ball of glass in a glowing room, and a rough mirror: what the path tracer sees there.
TEST_CASE("pictures show what the path tracer sees") {
    Scene scene = glowing();
    add_ball(scene, {0.3, 0.5, 0.5}, 0.2, 8, glass(1.5, 2));
    add_plate(scene, {0.6, 0.3, 0.3}, {0, 0.4, 0}, {0.2, 0, 0.3}, mirror(0.8, 0.5));
    const Patches patches = make_patches(scene);
    int k = 0;
    for (const glm::dvec3& to : {glm::dvec3(0.3, 0.55, 0.52), glm::dvec3(0.3, 0.4, 0.4),
                                 glm::dvec3(0.3, 0.5, 0.65), glm::dvec3(0.7, 0.5, 0.45)}) {
        const Camera camera = looking({0.5, 0.05, 0.45}, to);
        PathSettings settings;
        settings.paths = 200'000;
        settings.seed = std::uint64_t(++k);
        // The middle of the picture, as the camera's one ray has it.
        const PathEstimate seen =
            traced_radiance(scene, patches, camera.position, camera.forward, settings);
        const Picture picture = shot(scene, camera, 2048);
        Sample pixels;
        for (std::size_t i = 0; i < 16; ++i)
            pixels.add(picture.radiance[i]);
        CAPTURE(seen.mean[0]);
        CAPTURE(pixels.mean());
        CHECK(std::fabs(pixels.mean() - seen.mean[0]) <
              5 * std::hypot(seen.error[0], pixels.standard_error()) + 0.005 * seen.mean[0]);
    }
}
