#pragma once

#include <array>
#include <cstdint>

#include "parallux/picture.h"

namespace parallux {

/// Luminance of Rec. 709 for three bands, else the mean of the bands.
double luminance(const float* values, std::uint32_t bands);

/// What exposure brings to: the linear value of middle grey.
inline constexpr double middle_grey = 0.18;

/// Log-mean radiance of the patches that mostly reflect, by area: how bright a sample is beside the
/// rest. Those below a thousandth of the mean are not among them. 1 where nothing is lit.
double usual_luminance(const Patches& patches, const Solution& solution);

/// The factor that brings a picture to the screen: the log-mean of what is lit, neither emitter,
/// sky nor black, to middle grey, then `exposure` stops. 1 where nothing is lit.
double exposure_factor(const Picture& picture, const PictureSettings& settings);

/// Film's answer to exposed light: a toe, a straight part through middle grey (0.18 → 0.18) and a
/// shoulder that ends in 1. Monotone. Constants of Hable, Filmic Tonemapping for Real-time
/// Rendering, 2010.
double film(double light);

/// A colour through film() by its largest channel, so that hues hold; what is compressed much goes
/// to white. Without `filmic` each channel is clamped to 1.
std::array<double, 3> tone_map(std::array<double, 3> light, bool filmic);

/// Linear [0, 1] to sRGB's encoded [0, 1], IEC 61966-2-1.
double encode_srgb(double linear);

/// Encoded [0, 1] to 0 … 255, dithered by one level's width so that gradients show no steps; the
/// dither is a pure function of place and channel. 0 and 1 stay 0 and 255.
std::uint8_t quantise(double encoded, std::uint32_t x, std::uint32_t y, std::uint32_t channel);

/// The picture as 8 bit sRGB, three channels, row 0 at the top.
std::vector<std::uint8_t> screen_pixels(const Picture& picture, const PictureSettings& settings);

}  // namespace parallux
