#include <fstream>

#include <unistd.h>

#include "fuzz.h"

// The input is a URI in a scene file. Wherever it leads must lie below the scene's folder, which
// has links inward and outward.

using namespace parallux;
namespace fs = std::filesystem;

namespace {

class Tree {
public:
    Tree() {
        std::string name = (fs::temp_directory_path() / "parallux-fuzz-XXXXXX").string();
        fuzz::require(mkdtemp(name.data()) != nullptr, "a folder to work in");
        root_ = fs::canonical(name);
        fs::create_directories(folder() / "in" / "deep");
        std::ofstream(root_ / "secret") << "secret";
        std::ofstream(folder() / "in" / "a") << "a";
        fs::create_symlink("in", folder() / "good");
        fs::create_symlink("..", folder() / "up");
        fs::create_symlink("/", folder() / "root");
        fs::create_symlink("../secret", folder() / "file");
        fs::create_symlink("../../..", folder() / "in" / "out");
        fs::create_symlink("loop", folder() / "loop");
        fs::create_symlink(folder().string() + "-beside", folder() / "beside");
        fs::create_directories(folder().string() + "-beside");
    }
    ~Tree() { fs::remove_all(root_); }

    fs::path folder() const { return root_ / "scene"; }

private:
    fs::path root_;
};

// Whether a path, once its links are followed, begins with another.
bool below(const fs::path& path, const fs::path& folder) {
    const fs::path inside = fs::weakly_canonical(path).lexically_relative(folder);
    return !inside.empty() && *inside.begin() != "..";
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Tree tree;
    fuzz::ends_well({Fault::input}, [&] {
        const fs::path path =
            resolve_below(tree.folder() / "scene.json", "/meshes/0/file",
                          std::string_view(reinterpret_cast<const char*>(data), size));
        fuzz::require(below(path, tree.folder()), "no way out of the scene's folder");
    });
    return 0;
}
