#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace parallux {

/// A picture as a library call wants it: `channels` interleaved, with what the file says of itself.
struct Image {
    OIIO::ImageSpec spec;
    std::vector<float> linear;          ///< EXR
    std::vector<std::uint8_t> encoded;  ///< PNG
};

/// The file's bytes, made in memory: only OutputFile touches the disk, and notices what fails
/// there. Equal pictures give equal bytes: the date is SOURCE_DATE_EPOCH or 1970. Throws
/// std::exception.
std::vector<unsigned char> encode(const std::string& ending, Image& image);

/// The channel of a band: R, G, B of three, else 0 … K-1.
std::string band_channel(std::uint32_t bands, std::uint32_t band);

}  // namespace parallux
