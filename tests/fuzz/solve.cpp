#include "parallux/solve.h"
#include "made_scene.h"
#include "parallux/patches.h"

// Whole solves of small scenes: the balance closes, nobody has less than they emit, all is finite,
// and two threads find the bits that one does.

using namespace parallux;
using fuzz::require;

namespace {

Scene scene_of(fuzz::Bytes& bytes) {
    Scene scene;
    const unsigned kind = bytes.byte();
    if (kind % 2 == 0)
        scene = fuzz::solids(bytes);
    else
        scene = test::room(test::grey(0.5), 1 + bytes.below(3));
    scene.bands = 1 + kind / 2 % 2 * 2;
    fuzz::add_sheets(scene, bytes, bytes.below(4));
    for (Material& material : scene.materials)
        for (std::size_t b = 0; b < scene.bands; ++b) {
            material.reflectance[b] = static_cast<float>(bytes.below(9)) * 0.12f;
            material.emission[b] = bytes.below(3) ? 0 : std::ldexp(1.0f, int(bytes.below(64)) - 32);
        }
    if (kind / 4 % 4 == 0) {
        scene.sky.kind = Sky::Kind::uniform;
        scene.sky.zenith = Spectrum::constant(1);
    }
    if (kind / 16 % 4 == 0) {
        Light light;
        light.position = fuzz::point(bytes, false);
        light.intensity = Spectrum::constant(2);
        scene.lights.push_back(light);
    }
    for (glm::dvec3& p : scene.positions)
        p = (p + double(kind / 64 % 2) * 1e3) * (kind / 128 ? 1e-6 : 1.0);
    return scene;
}

SolveSettings settings_of(fuzz::Bytes& bytes) {
    constexpr Method methods[8] = {Method::bundles, Method::bundles,  Method::bundles,
                                   Method::bundles, Method::lines,    Method::progressive,
                                   Method::lines,   Method::particles};
    constexpr FirstShot shots[4] = {FirstShot::automatic, FirstShot::off, FirstShot::rays,
                                    FirstShot::exact};
    SolveSettings settings;
    settings.method = methods[bytes.below(8)];
    settings.direction = bytes.below(2) ? Direction::oriented : Direction::bidirectional;
    settings.first_shot = shots[bytes.below(4)];
    settings.first_shot_rays = 256;
    if (settings.method == Method::bundles)
        settings.bundles = 1 + bytes.below(24);
    else
        settings.lines = 1 + 8 * bytes.below(64);
    settings.lines_per_patch = 1 + bytes.below(4);
    settings.batch = bytes.below(4);
    settings.directions = bytes.below(2) ? DirectionSet::random : DirectionSet::lattice;
    settings.seed = bytes.byte();
    return settings;
}

// A mirror, rough or not, or glass. Light between perfect ones would not end.
void make_specular(Material& material, fuzz::Bytes& bytes) {
    const unsigned kind = bytes.below(16);
    if (kind > 10)
        return;
    Specular& specular = material.specular;
    specular.kind = kind < 6 ? Specular::Kind::mirror : Specular::Kind::glass;
    specular.share = static_cast<float>(4 - bytes.below(5)) / 4;
    specular.colour = Spectrum::constant(static_cast<float>(bytes.below(9)) * 0.12f);
    specular.grazing = Spectrum::constant(static_cast<float>(bytes.below(9)) * 0.125f);
    specular.roughness = kind == 0 ? static_cast<float>(bytes.below(5)) * 0.25f : 0;
    specular.ior = bytes.real(1, 4);
    specular.absorption[0] = static_cast<float>(bytes.below(3));
    specular.thin = kind % 2 == 0;
    if (specular.kind == Specular::Kind::glass)
        material.two_sided = true;
    if (specular.share == 1)
        material.reflectance = {};
}

// Behind all else, so that inputs without these bytes mean what they did.
void make_specular(Scene& scene, SolveSettings& settings, fuzz::Bytes& bytes) {
    if (bytes.empty())
        return;
    for (Material& material : scene.materials)
        make_specular(material, bytes);
    if (bytes.below(8) == 0)
        return;
    // Most often as it can be solved.
    settings.method = Method::bundles;
    settings.direction = Direction::bidirectional;
    settings.bundles = 1 + bytes.below(24);
    settings.shots = bytes.below(3);
    if (settings.first_shot == FirstShot::exact)
        settings.first_shot = FirstShot::rays;
}

void check(const Patches& patches, const Solution& solution) {
    for (std::size_t k = 0; k < patches.count() * patches.bands; ++k) {
        const float b = solution.radiosity[k], h = solution.irradiance[k], e = patches.emission[k];
        require(std::isfinite(b) && std::isfinite(h), "finite values");
        require(h >= 0, "H >= 0");
        require(b >= e * (1 - 1e-6f), "B >= E");
    }
    const Balance& energy = solution.energy;
    for (std::size_t b = 0; b < energy.residual.size(); ++b)
        require(energy.residual[b] == 0 &&
                    energy.emitted[b] == energy.absorbed[b] + energy.escaped[b] + energy.unshot[b],
                "a balance that closes");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    SolveSettings settings = settings_of(bytes);
    Scene scene = scene_of(bytes);
    make_specular(scene, settings, bytes);
    fuzz::ends_well({Fault::usage, Fault::input, Fault::memory}, [&] {
        const Patches patches = make_patches(scene, {.count = 32});
        settings.threads = 1;
        const Solution one = solve(scene, patches, settings);
        check(patches, one);
        settings.threads = 2;
        require(solve(scene, patches, settings).hash == one.hash, "equal bits on two threads");
    });
    return 0;
}
