#include <algorithm>
#include <cmath>

#include "scene/sky_models.h"

// R. Perez, R. Seals and J. Michalsky, All-weather model for sky luminance distribution, Solar
// Energy 50(3), 1993, with the erratum in 51(5).

namespace parallux {
namespace {

// Upper ends of the bins of clearness, but for the last (table 1 of R. Perez, P. Ineichen, R.
// Seals, J. Michalsky and R. Stewart, Modeling daylight availability and irradiance components,
// Solar Energy 44(5), 1990).
constexpr double clearness_bins[] = {1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};

// Table 1: of each of a … e, four numbers x₁ + x₂ Z + Δ (x₃ + x₄ Z).
struct Bin {
    double a[4], b[4], c[4], d[4], e[4];
};
constexpr Bin bins[8] = {
    {{1.3525, -0.2576, -0.2690, -1.4366},
     {-0.7670, 0.0007, 1.2734, -0.1233},
     {2.8000, 0.6004, 1.2375, 1.0000},
     {1.8734, 0.6297, 0.9738, 0.2809},
     {0.0356, -0.1246, -0.5718, 0.9938}},
    {{-1.2219, -0.7730, 1.4148, 1.1016},
     {-0.2054, 0.0367, -3.9128, 0.9156},
     {6.9750, 0.1774, 6.4477, -0.1239},
     {-1.5798, -0.5081, -1.7812, 0.1080},
     {0.2624, 0.0672, -0.2190, -0.4285}},
    {{-1.1000, -0.2515, 0.8952, 0.0156},
     {0.2782, -0.1812, -4.5000, 1.1766},
     {24.7219, -13.0812, -37.7000, 34.8438},
     {-5.0000, 1.5218, 3.9229, -2.6204},
     {-0.0156, 0.1597, 0.4199, -0.5562}},
    {{-0.5484, -0.6654, -0.2672, 0.7117},
     {0.7234, -0.6219, -5.6812, 2.6297},
     {33.3389, -18.3000, -62.2500, 52.0781},
     {-3.5000, 0.0016, 1.1477, 0.1062},
     {0.4659, -0.3296, -0.0876, -0.0329}},
    {{-0.6000, -0.3566, -2.5000, 2.3250},
     {0.2937, 0.0496, -5.6812, 1.8415},
     {21.0000, -4.7656, -21.5906, 7.2492},
     {-3.5000, -0.1554, 1.4062, 0.3988},
     {0.0032, 0.0766, -0.0656, -0.1294}},
    {{-1.0156, -0.3670, 1.0078, 1.4051},
     {0.2875, -0.5328, -3.8500, 3.3750},
     {14.0000, -0.9999, -7.1406, 7.5469},
     {-3.4000, -0.1078, -1.0750, 1.5702},
     {-0.0672, 0.4016, 0.3017, -0.4844}},
    {{-1.0000, 0.0211, 0.5025, -0.5119},
     {-0.3000, 0.1922, 0.7023, -1.6317},
     {19.0000, -5.0000, 1.2438, -1.9094},
     {-4.0000, 0.0250, 0.3844, 0.2656},
     {1.0468, -0.3788, -2.4517, 1.4656}},
    {{-1.0500, 0.0289, 0.4260, 0.3590},
     {-0.3250, 0.1156, 0.7781, 0.0025},
     {31.0625, -14.5000, -46.1148, 55.3750},
     {-7.2312, 0.4050, 13.3500, 0.6234},
     {1.5000, -0.6426, 1.8564, 0.5636}},
};

// F. Kasten and A. T. Young, Revised optical air mass tables and approximation formula, Applied
// Optics 28(22), 1989.
double air_mass(double elevation) {
    return 1 / (std::sin(elevation) + 0.50572 * std::pow(elevation * 180 / pi + 6.07995, -1.6364));
}

}  // namespace

SkyShape perez_shape(const glm::dvec3& sun, double elevation, double direct, double diffuse) {
    const double zenith_angle = pi / 2 - elevation;
    const double cube = 1.041 * std::pow(zenith_angle, 3);
    const double clearness = ((diffuse + direct) / diffuse + cube) / (1 + cube);
    constexpr double extraterrestrial = 1367;  // W/m², the mean over the year that they took
    double brightness = diffuse * air_mass(elevation) / extraterrestrial;
    // Outside what the table was fitted to it gives skies that are dark where they should shine;
    // the limits are those of Radiance's gendaylit (J.-J. Delaunay, 1994).
    brightness = std::clamp(brightness, clearness > 1.065 && clearness < 2.8 ? 0.2 : 0.01, 0.6);

    const auto bin =
        std::upper_bound(std::begin(clearness_bins), std::end(clearness_bins), clearness) -
        std::begin(clearness_bins);
    const Bin& x = bins[bin];
    auto linear = [&](const double(&k)[4]) {
        return k[0] + k[1] * zenith_angle + brightness * (k[2] + k[3] * zenith_angle);
    };
    SkyShape shape{linear(x.a), linear(x.b), linear(x.c), linear(x.d), linear(x.e), 0, sun, 1};
    if (bin == 0) {
        shape.c =
            std::exp(std::pow(brightness * (x.c[0] + x.c[1] * zenith_angle), x.c[2])) - x.c[3];
        shape.d =
            -std::exp(brightness * (x.d[0] + x.d[1] * zenith_angle)) + x.d[2] + brightness * x.d[3];
    }
    // Light that grows away from the sun is none that the table means.
    shape.d = std::min(shape.d, 0.0);
    return shape;
}

}  // namespace parallux
