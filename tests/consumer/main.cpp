#include <cstdio>

#include <parallux/parallux.h>

// Two parallel unit squares, one metre apart, facing each other; the lower one shines. Their form
// factor is 0.1998, so the upper one's irradiance is about that share of E.
int main() {
    using namespace parallux;
    Scene scene;
    scene.bands = 1;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                       {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    scene.materials.resize(2);
    scene.materials[0].emission = Spectrum::constant(1);
    scene.objects = {"squares"};
    scene.surfaces.resize(2);
    scene.surfaces[0].corner = {0, 1, 2, 3};
    scene.surfaces[1].corner = {4, 5, 6, 7};
    scene.surfaces[1].material = 1;
    for (Surface& surface : scene.surfaces)
        surface.grid_u = surface.grid_v = 1;

    SolveSettings settings;
    settings.bundles = 4096;
    settings.line_spacing = 0.02;
    Solution solution = solve(scene, make_patches(scene), settings);
    const double factor = static_cast<double>(solution.irradiance.at(1));
    std::printf("form factor %.4f, exact 0.1998\n", factor);
    return factor > 0.19 && factor < 0.21 ? 0 : 1;
}
