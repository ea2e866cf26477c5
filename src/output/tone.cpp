#include "output/tone.h"

#include <algorithm>
#include <cmath>

#include "parallel.h"
#include "random.h"

namespace parallux {

namespace {

double hable(double x) {
    constexpr double a = 0.15, b = 0.50, c = 0.10, d = 0.20, e = 0.02, f = 0.30;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

// Scale that takes middle grey to itself when Hable's 11.2 is white; see the test of film().
constexpr double film_white = 11.2;
constexpr double film_scale = 2.92752283;

}  // namespace

double luminance(const float* values, std::uint32_t bands) {
    if (bands == 3)
        return 0.2126 * values[0] + 0.7152 * values[1] + 0.0722 * values[2];
    double sum = 0;
    for (std::uint32_t b = 0; b < bands; ++b)
        sum += values[b];
    return bands ? sum / bands : 0;
}

double exposure_factor(const Picture& picture, const PictureSettings& settings) {
    double stops = std::exp2(settings.exposure);
    if (!settings.automatic_exposure)
        return stops;
    // Take the pixels whose light is mostly reflected.
    std::vector<float> lit;
    std::array<float, max_bands> reflected{};
    for (std::size_t i = 0; i < picture.alpha.size(); ++i) {
        const float* seen = &picture.radiance[i * picture.bands];
        for (std::uint32_t b = 0; b < picture.bands; ++b)
            reflected[b] = static_cast<float>(picture.albedo[i * picture.bands + b] *
                                              picture.irradiance[i * picture.bands + b] / pi);
        double l = luminance(seen, picture.bands);
        if (picture.alpha[i] > 0.5f && l > 0 && luminance(reflected.data(), picture.bands) > l / 2)
            lit.push_back(static_cast<float>(l));
    }
    if (lit.empty())
        return stops;
    // Average the logarithms between the 5th and the 95th percentile.
    std::sort(lit.begin(), lit.end());
    std::size_t tail = lit.size() / 20;
    double sum = 0;
    for (std::size_t i = tail; i < lit.size() - tail; ++i)
        sum += std::log(double(lit[i]));
    return stops * middle_grey / std::exp(sum / double(lit.size() - 2 * tail));
}

double usual_luminance(const Patches& patches, const Solution& solution) {
    // The light of a patch that mostly reflects; 0 of others.
    auto reflected = [&](std::size_t p) {
        const double l = luminance(&solution.radiosity[p * solution.bands], solution.bands) / pi;
        const double e = luminance(&patches.emission[p * solution.bands], solution.bands) / pi;
        return e < l / 2 ? l : 0;
    };
    double light = 0, lit = 0;
    for (std::size_t p = 0; p < patches.count(); ++p) {
        if (const double l = reflected(p); l > 0)
            light += patches.area[p] * l, lit += patches.area[p];
    }
    // What is all but dark has no say: the outer sides of walls, where a crack lets a glint
    // through.
    const double dark = lit > 0 ? 1e-3 * light / lit : 0;
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < patches.count(); ++p) {
        if (const double l = reflected(p); l > dark)
            sum += patches.area[p] * std::log(l), area += patches.area[p];
    }
    return area > 0 ? std::exp(sum / area) : 1;
}

double film(double light) {
    return std::clamp(hable(film_scale * std::max(light, 0.0)) / hable(film_white), 0.0, 1.0);
}

std::array<double, 3> tone_map(std::array<double, 3> light, bool filmic) {
    double peak = std::max({light[0], light[1], light[2], 0.0});
    if (!filmic || !(peak > 0)) {
        for (double& channel : light)
            channel = std::clamp(channel, 0.0, 1.0);
        return light;
    }
    double shown = film(peak);
    // The more stops above the shoulder's begin, the closer to white.
    double excess = std::max(0.0, std::log2(peak / 0.8));
    double white = 1 - 1 / (1 + 0.15 * excess * excess);
    for (double& channel : light) {
        double coloured = std::max(channel, 0.0) / peak * shown;
        channel = coloured + white * (shown - coloured);
    }
    return light;
}

double encode_srgb(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t quantise(double encoded, std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    double level = 255 * std::clamp(encoded, 0.0, 1.0);
    double dither =
        Random(0x70696374, std::uint64_t(y) << 34 | std::uint64_t(x) << 2 | channel).uniform();
    double low = std::floor(level);
    return static_cast<std::uint8_t>(level - low > dither ? low + 1 : low);
}

std::vector<std::uint8_t> screen_pixels(const Picture& picture, const PictureSettings& settings) {
    double factor = exposure_factor(picture, settings);
    const std::vector<float>& source = picture.display.empty() ? picture.radiance : picture.display;
    std::vector<std::uint8_t> pixels(3 * std::size_t(picture.width) * picture.height);
    parallel_for(settings.threads, picture.height, 16, [&](std::size_t b, std::size_t e, unsigned) {
        for (std::size_t y = b; y < e; ++y)
            for (std::size_t x = 0; x < picture.width; ++x) {
                std::size_t i = y * picture.width + x;
                const float* from = &source[i * picture.bands];
                std::array<double, 3> light;
                if (picture.bands == 3)
                    light = {factor * from[0], factor * from[1], factor * from[2]};
                else
                    light.fill(factor * luminance(from, picture.bands));
                light = tone_map(light, settings.filmic);
                for (std::uint32_t c = 0; c < 3; ++c)
                    pixels[3 * i + c] = quantise(encode_srgb(light[c]), static_cast<unsigned>(x),
                                                 static_cast<unsigned>(y), c);
            }
    });
    return pixels;
}

}  // namespace parallux
