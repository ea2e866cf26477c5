#include <exception>
#include <string>

#include "output/encode.h"
#include "output/output_file.h"
#include "output/tone.h"
#include "parallux/error.h"
#include "parallux/picture.h"

namespace parallux {

namespace {

// A layer's values and the names of its channels.
struct Layer {
    const std::vector<float>* values;
    std::vector<std::string> channels;
};

std::vector<Layer> layers(const Picture& picture) {
    auto per_band = [&](const std::string& prefix) {
        std::vector<std::string> names;
        for (std::uint32_t b = 0; b < picture.bands; ++b)
            names.push_back(prefix + band_channel(picture.bands, b));
        return names;
    };
    std::vector<Layer> result = {{&picture.radiance, per_band("")},
                                 {&picture.alpha, {"A"}},
                                 {&picture.irradiance, per_band("irradiance.")},
                                 {&picture.albedo, per_band("albedo.")},
                                 {&picture.normal, {"normal.X", "normal.Y", "normal.Z"}},
                                 {&picture.patch, {"patch.id"}}};
    if (!picture.stderror.empty())
        result.push_back({&picture.stderror, per_band("stderr.")});
    return result;
}

Image linear_image(const Picture& picture) {
    Image image;
    std::vector<Layer> all = layers(picture);
    std::vector<std::string> names;
    for (const Layer& layer : all)
        names.insert(names.end(), layer.channels.begin(), layer.channels.end());
    image.spec = OIIO::ImageSpec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                                 static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
    image.spec.channelnames = names;
    image.spec.alpha_channel = static_cast<int>(picture.bands);
    image.spec.attribute("compression", "zip");
    image.spec.attribute("oiio:ColorSpace", "Linear");
    // Interleave the layers.
    std::size_t pixels = std::size_t(picture.width) * picture.height;
    image.linear.resize(pixels * names.size());
    std::size_t at = 0;
    for (const Layer& layer : all) {
        std::size_t n = layer.channels.size();
        for (std::size_t i = 0; i < pixels; ++i)
            for (std::size_t c = 0; c < n; ++c)
                image.linear[i * names.size() + at + c] = (*layer.values)[i * n + c];
        at += n;
    }
    return image;
}

Image screen_image(const Picture& picture, const PictureSettings& settings) {
    Image image;
    image.spec = OIIO::ImageSpec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                                 3, OIIO::TypeDesc::UINT8);
    image.spec.attribute("oiio:ColorSpace", "sRGB");
    image.encoded = screen_pixels(picture, settings);
    return image;
}

// What a screen needs, of the bands it is to show.
Picture only(const Picture& picture, const std::vector<std::uint32_t>& bands) {
    Picture shown;
    shown.width = picture.width;
    shown.height = picture.height;
    shown.bands = static_cast<std::uint32_t>(bands.size());
    shown.alpha = picture.alpha;
    for (auto layer :
         {&Picture::radiance, &Picture::display, &Picture::irradiance, &Picture::albedo})
        for (std::size_t first = 0; first < (picture.*layer).size(); first += picture.bands)
            for (std::uint32_t band : bands)
                (shown.*layer).push_back((picture.*layer).at(first + band));
    return shown;
}

// One band in grey, or three in colour; others have to be chosen.
Image png_image(const std::filesystem::path& file, const Picture& picture,
                const PictureSettings& settings) {
    if (!settings.shown_bands.empty())
        return screen_image(only(picture, settings.shown_bands), settings);
    if (picture.bands != 1 && picture.bands != 3)
        throw Error(Fault::usage, file.string() + ": PNG shows one band or three, not " +
                                      std::to_string(picture.bands) + "; choose which");
    return screen_image(picture, settings);
}

}  // namespace

void write_picture(const std::filesystem::path& file, const Picture& picture,
                   const PictureSettings& settings) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending != ".exr" && ending != ".png")
        throw Error(Fault::output, file.string() + ": cannot write '" + ending +
                                       "' pictures; name the file .exr or .png");
    if (picture.width == 0 || picture.height == 0)
        throw Error(Fault::output, file.string() + ": cannot write a picture without pixels");
    OutputFile output(file);
    std::vector<unsigned char> bytes;
    try {
        Image image = ending == ".exr" ? linear_image(picture) : png_image(file, picture, settings);
        bytes = encode(ending, image);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, file.string() + ": no memory to encode the picture");
    } catch (const std::exception& failure) {
        throw Error(Fault::output, file.string() + ": cannot write: " + failure.what());
    }
    output.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    output.commit();
}

}  // namespace parallux
