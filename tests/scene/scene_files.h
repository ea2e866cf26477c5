#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <unistd.h>

#include "parallux/error.h"
#include "parallux/scene.h"

/// A folder of its own for the files of one test; gone afterwards.
class TestFolder {
public:
    TestFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "parallux-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        path_ = name;
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }
    TestFolder(const TestFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// What loading says is wrong; "" when it loads. Any fault but `input` fails the test.
inline std::string fault_of(const std::filesystem::path& file) {
    try {
        parallux::load_scene(file);
        return "";
    } catch (const parallux::Error& error) {
        CHECK(error.fault() == parallux::Fault::input);
        std::string what = error.what();
        CHECK(what.find('\n') == what.npos);
        CHECK(what.find(file.parent_path().string()) != what.npos);
        return what;
    }
}

inline bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

inline double total_area(const parallux::Scene& scene) {
    double sum = 0;
    for (const parallux::Surface& s : scene.surfaces)
        sum += parallux::surface_area(scene, s);
    return sum;
}

inline std::size_t parallelograms(const parallux::Scene& scene) {
    std::size_t n = 0;
    for (const parallux::Surface& s : scene.surfaces)
        n += s.shape() == parallux::Shape::parallelogram;
    return n;
}
