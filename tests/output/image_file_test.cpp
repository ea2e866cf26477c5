#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

#include "output/tone.h"
#include "parallux/error.h"
#include "parallux/picture.h"

using namespace parallux;
namespace fs = std::filesystem;

namespace {

// A folder of its own that goes with the test.
struct Folder {
    fs::path path = fs::temp_directory_path() / ("parallux-picture-" + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
};

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A picture whose every value tells its place.
Picture sample_picture(std::uint32_t bands, bool stderror = false) {
    Picture p;
    p.width = 70, p.height = 50, p.bands = bands;
    std::size_t pixels = 70 * 50;
    auto fill = [](std::vector<float>& layer, std::size_t n, float base) {
        for (std::size_t i = 0; i < n; ++i)
            layer.push_back(base + float(i) / 1024);
    };
    fill(p.radiance, pixels * bands, 0.01f), fill(p.irradiance, pixels * bands, 20);
    fill(p.albedo, pixels * bands, 0), fill(p.normal, pixels * 3, -1);
    fill(p.patch, pixels, -1);
    p.alpha.assign(pixels, 1);
    if (stderror)
        fill(p.stderror, pixels * bands, 3);
    return p;
}

Fault fault_of(const fs::path& file, const Picture& picture) {
    try {
        write_picture(file, picture, {});
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find(file.filename().string()) != std::string::npos);
        return error.fault();
    }
    return Fault{};
}

}  // namespace

// Planted errors: layers interleaved with the wrong stride; values exposed or encoded in EXR.
TEST_CASE("an EXR holds every layer as it is") {
    Folder folder;
    for (std::uint32_t bands : {1u, 3u, 8u}) {
        Picture picture = sample_picture(bands, bands == 3);
        fs::path file = folder.path / "layers.exr";
        write_picture(file, picture, {});
        auto in = OIIO::ImageInput::open(file.string());
        REQUIRE(in);
        const OIIO::ImageSpec& spec = in->spec();
        std::size_t n = static_cast<std::size_t>(spec.nchannels);
        CHECK(n == 3 * bands + 5 + (bands == 3 ? 3 : 0));
        std::vector<float> values(n * 70 * 50);
        REQUIRE(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
        auto check = [&](const char* name, const std::vector<float>& layer, std::size_t stride,
                         std::size_t offset) {
            int channel = spec.channelindex(name);
            REQUIRE(channel >= 0);
            for (std::size_t i = 0; i < 70 * 50; ++i)
                REQUIRE(values[i * n + std::size_t(channel)] == layer[i * stride + offset]);
        };
        std::uint32_t last = bands - 1;
        std::string band = bands == 3 ? "B" : std::to_string(last);
        check(band.c_str(), picture.radiance, bands, last);
        check(("irradiance." + band).c_str(), picture.irradiance, bands, last);
        check(("albedo." + band).c_str(), picture.albedo, bands, last);
        check("normal.Y", picture.normal, 3, 1);
        check("patch.id", picture.patch, 1, 0);
        check("A", picture.alpha, 1, 0);
        if (bands == 3)
            check("stderr.G", picture.stderror, 3, 1);
    }
}

// Planted error: the time of writing in the file's header.
TEST_CASE("equal pictures give equal files") {
    Folder folder;
    for (const char* name : {"a.png", "a.exr"}) {
        fs::path file = folder.path / name;
        write_picture(file, sample_picture(3), {});
        std::string first = bytes_of(file);
        sleep(1);
        write_picture(file, sample_picture(3), {});
        CHECK(first.size() > 500);
        CHECK(first == bytes_of(file));
    }
    CHECK(folder.files() == 2);
}

// Planted error: a write whose failure is not asked for, or a temporary that is left behind.
TEST_CASE("what cannot be written is an output fault and leaves the older file") {
    Folder folder;
    Picture picture = sample_picture(3);
    CHECK(fault_of(folder.path / "no" / "folder.png", picture) == Fault::output);
    CHECK(fault_of(folder.path / "wrong.jpeg", picture) == Fault::output);
    fs::create_directory(folder.path / "taken.png");
    CHECK(fault_of(folder.path / "taken.png", picture) == Fault::output);
    for (const char* name : {"full.png", "full.exr"}) {
        std::ofstream(folder.path / name) << "older";
        std::size_t files = folder.files();
        // A full disk: no file may grow beyond 256 bytes.
        auto before = std::signal(SIGXFSZ, SIG_IGN);
        rlimit old{};
        getrlimit(RLIMIT_FSIZE, &old);
        rlimit tight{256, old.rlim_max};
        setrlimit(RLIMIT_FSIZE, &tight);
        Fault fault = fault_of(folder.path / name, picture);
        setrlimit(RLIMIT_FSIZE, &old);
        std::signal(SIGXFSZ, before);
        CHECK(fault == Fault::output);
        CHECK(bytes_of(folder.path / name) == "older");
        CHECK(folder.files() == files);
    }
}

// Planted errors: another white or scale of the curve; a curve that falls.
TEST_CASE("film takes middle grey to itself, rises, and ends in white") {
    CHECK(film(0.18) == doctest::Approx(0.18).epsilon(1e-6));
    CHECK(film(0) == doctest::Approx(0).epsilon(1e-9));
    CHECK(film(100) == 1);
    for (double x = 0; x < 3.7; x += 0.01)
        CHECK(film(x + 0.01) > film(x));
    auto grey = tone_map({0.18, 0.18, 0.18}, true);
    CHECK(grey[0] == doctest::Approx(0.18).epsilon(1e-6));
    auto red = tone_map({0.4, 0.04, 0.02}, true);
    CHECK(red[0] / red[1] == doctest::Approx(10));
}

// Planted errors: the wrong branch of the sRGB curve; dither with a mean other than the value, or
// the same for every pixel.
TEST_CASE("quantised values keep their mean, and the ends stay") {
    CHECK(encode_srgb(0.0031308) == doctest::Approx(0.0404482).epsilon(1e-4));
    CHECK(encode_srgb(0.214041) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(encode_srgb(1) == doctest::Approx(1));
    for (double level : {0.0, 100.3, 100.5, 255.0}) {
        double sum = 0;
        for (std::uint32_t y = 0; y < 100; ++y)
            for (std::uint32_t x = 0; x < 100; ++x)
                sum += quantise(level / 255, x, y, 1);
        CHECK(sum / 1e4 == doctest::Approx(level).epsilon(1e-4));
    }
}

// Planted errors: emitters, sky or black pixels taken into the mean; stops applied twice.
TEST_CASE("exposure brings the lit surfaces' log-mean to middle grey") {
    Picture p = sample_picture(3);
    for (std::size_t i = 0; i < 70 * 50; ++i) {
        p.alpha[i] = i % 5 == 0 ? 0.0f : 1.0f;
        for (std::size_t b = 0; b < 3; ++b) {
            bool lamp = i % 7 == 0, black = i % 11 == 0;
            p.albedo[3 * i + b] = 0.5f;
            p.irradiance[3 * i + b] = black ? 0 : float((i % 2 ? 2 : 8) * pi);
            p.radiance[3 * i + b] = 0.5f * p.irradiance[3 * i + b] / float(pi) +
                                    (lamp ? 1000.0f : 0.0f) + (p.alpha[i] == 0 ? 50.0f : 0.0f);
        }
    }
    PictureSettings settings;
    CHECK(exposure_factor(p, settings) == doctest::Approx(0.18 / 2).epsilon(0.03));
    settings.exposure = 1;
    CHECK(exposure_factor(p, settings) == doctest::Approx(0.36 / 2).epsilon(0.03));
    settings.automatic_exposure = false;
    CHECK(exposure_factor(p, settings) == 2);
}
