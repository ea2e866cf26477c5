#include "output/encode.h"

#include <cstdlib>
#include <ctime>
#include <memory>

#include <OpenImageIO/filesystem.h>

namespace parallux {

namespace {

// One moment for all files, so that equal runs give equal bytes.
std::string date_time() {
    std::time_t seconds = 0;
    if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"))
        seconds = static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10));
    std::tm parts{};
    char text[32] = "1970:01:01 00:00:00";
    if (gmtime_r(&seconds, &parts))
        std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &parts);
    return text;
}

}  // namespace

std::string band_channel(std::uint32_t bands, std::uint32_t band) {
    return bands == 3 ? std::string(1, "RGB"[band]) : std::to_string(band);
}

std::vector<unsigned char> encode(const std::string& ending, Image& image) {
    image.spec.attribute("DateTime", date_time());
    image.spec.attribute("Software", "Parallux");
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    std::unique_ptr<OIIO::ImageOutput> writer = OIIO::ImageOutput::create("picture" + ending);
    if (!writer)
        throw std::runtime_error(OIIO::geterror());
    void* proxy = &memory;
    image.spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    bool linear = !image.linear.empty();
    const void* pixels = linear ? static_cast<const void*>(image.linear.data())
                                : static_cast<const void*>(image.encoded.data());
    if (!writer->open("picture" + ending, image.spec) ||
        !writer->write_image(linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8, pixels) ||
        !writer->close())
        throw std::runtime_error(writer->geterror());
    return bytes;
}

}  // namespace parallux
