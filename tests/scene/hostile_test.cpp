#include <cmath>
#include <functional>
#include <vector>

#include "parallux/patches.h"
#include "scene/loaders.h"
#include "scene_files.h"

// Files made to do harm: paths that lead out, numbers beyond all measure, scenes cut anywhere.

using namespace parallux;

namespace {

const std::filesystem::path scenes = PARALLUX_SCENES;

std::vector<std::filesystem::path> own_scenes() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(scenes))
        if (entry.path().extension() == ".gltf" ||
            (entry.path().extension() == ".json" && !holds(entry.path().string(), "schema")))
            files.push_back(entry.path());
    return files;
}

// Whether the bytes load; what is then in the scene must be finite.
bool loads(const std::filesystem::path& file, const std::string& bytes) {
    Scene scene;
    try {
        scene = scene_of(file, bytes, {});
    } catch (const Error& error) {
        const bool fits = error.fault() == Fault::input || error.fault() == Fault::memory;
        REQUIRE(fits);
        return false;
    }
    for (const glm::dvec3& p : scene.positions)
        REQUIRE(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) <= 3e15);
    for (const Material& material : scene.materials)
        for (std::size_t b = 0; b < scene.bands; ++b) {
            const float reflectance = material.reflectance[b], emission = material.emission[b];
            REQUIRE(reflectance >= 0);
            REQUIRE(reflectance < 1);
            REQUIRE(emission >= 0);
            REQUIRE(std::isfinite(emission));
        }
    return true;
}

// The text with its n-th number replaced; "" where there are not so many.
std::string with_number(const std::string& text, std::size_t n, const std::string& number) {
    auto in_number = [](char c) {
        return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e';
    };
    for (std::size_t at = 0; at < text.size();) {
        // Numbers stand behind a separator; digits within names do not count.
        const bool begins = at > 0 && holds(" ,[:\n", text.substr(at - 1, 1)) &&
                            ((text[at] >= '0' && text[at] <= '9') || text[at] == '-');
        std::size_t end = at;
        while (begins && end < text.size() && in_number(text[end]))
            ++end;
        if (begins && n-- == 0)
            return text.substr(0, at) + number + text.substr(end);
        at = std::max(end, at + 1);
    }
    return "";
}

const std::string hostile[] = {"NaN",
                               "Infinity",
                               "-Infinity",
                               "nan",
                               "inf",
                               "1e30",
                               "-1e30",
                               "1e308",
                               "1e400",
                               "-1",
                               "4294967296",
                               "18446744073709551615",
                               "99999999999999999999999",
                               "0.5",
                               "1e-320"};

}  // namespace

// Planted, seen: a coordinate of 1e30 let through (SceneBuilder::check left out).
TEST_CASE("NaN, infinities and numbers beyond all measure, in every number's place") {
    std::vector<std::pair<std::filesystem::path, std::string>> texts;
    for (const char* name : {"furnace.json", "naive_rule.json", "cornell_box.gltf"})
        texts.emplace_back(scenes / name, bytes_of(scenes / name));
    texts.emplace_back("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 1\nf 1/1 2/1 3/1 4/1\n");
    texts.emplace_back("a.stl",
                       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                       "vertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    std::size_t tried = 0, refused = 0;
    for (const auto& [file, text] : texts) {
        CAPTURE(file.string());
        REQUIRE(loads(file, text));
        for (std::size_t n = 0; n < 400; ++n)
            for (const std::string& number : hostile) {
                const std::string bytes = with_number(text, n, number);
                if (bytes.empty())
                    break;
                ++tried;
                refused += !loads(file, bytes);
            }
    }
    CHECK(tried > 3000);
    CHECK(refused > tried / 2);
}

// Planted, seen: the check for ".." left out of resolve_below, and the one that follows links.
TEST_CASE("no path leads out of the scene's folder, however it is written") {
    TestFolder folder;
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const char* name : {"secret.obj", "in/good.obj", "in/deep/good.obj", "in-beside/a.obj"})
        folder.write(name, triangle);
    const std::filesystem::path in = folder.path() / "in";
    std::filesystem::create_symlink("..", in / "up");
    std::filesystem::create_symlink("../secret.obj", in / "link.obj");
    std::filesystem::create_symlink("/", in / "root");
    std::filesystem::create_symlink("deep", in / "inward");
    std::filesystem::create_symlink("../in-beside", in / "beside");
    std::filesystem::create_symlink("loop.obj", in / "loop.obj");
    const std::string whole = (folder.path() / "secret.obj").string();
    auto says = [&](const std::string& name) {
        return fault_of(folder.write(
            "in/a.json", R"({"parallux": 1, "meshes": [{"file": ")" + name + R"("}]})"));
    };
    for (const char* name : {"good.obj", "./good.obj", "deep/good.obj", "inward/good.obj",
                             "%67ood.obj", "deep\\\\good.obj"})
        CHECK(says(name) == "");
    for (const std::string& name : {std::string("../secret.obj"),
                                    std::string("deep/../../secret.obj"),
                                    std::string("%2e%2e/secret.obj"),
                                    std::string("%2E%2E%2Fsecret.obj"),
                                    std::string("..%5csecret.obj"),
                                    std::string("..\\\\secret.obj"),
                                    std::string("./../secret.obj"),
                                    std::string("up/secret.obj"),
                                    std::string("link.obj"),
                                    "root" + whole,
                                    whole,
                                    "%2f" + whole.substr(1),
                                    "file://" + whole,
                                    "\\\\" + whole.substr(1),
                                    std::string("beside/a.obj"),
                                    std::string("up/in-beside/a.obj"),
                                    std::string("../in-beside/a.obj"),
                                    std::string("loop.obj"),
                                    std::string("good.obj%00"),
                                    std::string("")}) {
        CAPTURE(name);
        const std::string what = says(name);
        CHECK(holds(what, "/meshes/0/file"));
        CHECK(holds(what, "below the scene's folder"));
    }
}

// Planted, seen: an index that is compared with nothing (JsonView::at without its check) ends here.
TEST_CASE("scenes cut at every byte are refused, and read no byte beyond") {
    for (const std::filesystem::path& file : own_scenes()) {
        CAPTURE(file.string());
        const std::string bytes = bytes_of(file);
        const std::size_t text = bytes.find_last_of('}');
        REQUIRE(loads(file, bytes));
        // From a block of their own, so that a tool sees what reads beyond the end.
        for (std::size_t size = 0; size <= text; ++size)
            REQUIRE_FALSE(loads(file, bytes.substr(0, size)));
    }
}

TEST_CASE("counts beyond all memory are compared with the bytes there are") {
    TestFolder folder;
    folder.write("a.bin", std::string(36, '\0'));
    auto gltf = [&](const std::string& count, const std::string& length) {
        return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "accessors":
            [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
               count + R"(}], "bufferViews": [{"buffer": 0, "byteLength": )" + length +
               R"(}], "buffers": [{"uri": "a.bin", "byteLength": )" + length + "}]}";
    };
    for (const char* count : {"4", "1000000000", "4294967295", "18446744073709551615"})
        for (const char* length : {"36", "1000000000000", "18446744073709551615"}) {
            CAPTURE(count);
            CAPTURE(length);
            CHECK(fault_of(folder.write("a.gltf", gltf(count, length))) != "");
        }
    // A header that promises 4 294 967 295 facets.
    CHECK(fault_of(folder.write(
              "a.stl", std::string(80, ' ') + "\xFF\xFF\xFF\xFF" + std::string(50, '\0'))) != "");
    // A grid that no memory holds is refused before anything is taken.
    Scene scene = load_scene(folder.write(
        "a.json", R"({"parallux": 1, "surfaces": [{"box": {"low": [0, 0, 0], "high": [1, 1, 1]},
            "grid": [32768, 32768], "material": "a"}], "materials": [{"name": "a",
            "reflectance": 0.5}]})"));
    CHECK_THROWS_AS(make_patches(scene), Error);
}
