#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "fuzz.h"
#include "parallux/patches.h"
#include "parallux/solve.h"
#include "sealed_bytes.h"
#include "solve/checkpoint_writer.h"
#include "support/hand_made.h"

// The input is what a checkpoint keeps of a run, behind the version and hashes that name it: it is
// refused as damaged, or the run goes on from it to its end.

using namespace parallux;

namespace {

Scene room() {
    Scene scene = test::room(test::grey(0.5, 1), 1);
    test::add_light_and_sky(scene);
    return scene;
}

SolveSettings settings() {
    SolveSettings settings;
    settings.bundles = 64;
    settings.groups = 2;
    settings.threads = 1;
    settings.first_shot = FirstShot::rays;
    settings.first_shot_rays = 128;
    return settings;
}

// Of this process alone.
std::filesystem::path file() {
    return std::filesystem::temp_directory_path() /
           ("parallux_fuzz_" + std::to_string(getpid()) + ".plx");
}

std::string bytes_of_file() {
    std::ifstream in(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The body of a checkpoint of a run that is stopped when it is asked for the n-th time.
std::string body_of_run(int stop) {
    SolveSettings stopped = settings();
    stopped.checkpoints.file = file();
    int asked = 0;
    const Scene scene = room();
    solve(scene, make_patches(scene), stopped, [&](const Progress&) { return ++asked < stop; });
    const std::string bytes = bytes_of_file();
    std::filesystem::remove(file());
    return std::string(body_of(bytes));
}

// Version, hash of the scene and of the settings.
const std::string& identity() {
    static const std::string known = [] {
        const std::string body = body_of_run(20);
        return body.substr(0, 8 + std::string_view(PARALLUX_VERSION).size() + 16);
    }();
    return known;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // How the corpus was made: checkpoints of the run at each of its halts.
    if (const char* corpus = std::getenv("PARALLUX_FUZZ_CORPUS")) {
        for (int stop = 2; stop < 40; stop += 3)
            std::ofstream(corpus + std::string("/halt_") + std::to_string(stop), std::ios::binary)
                << body_of_run(stop).substr(identity().size());
        std::exit(0);
    }
    const std::string body = identity() + std::string(reinterpret_cast<const char*>(data), size);
    std::ofstream(file(), std::ios::binary) << fuzz::sealed(checkpoint_kind, body);
    SolveSettings resumed = settings();
    resumed.checkpoints.resume = file();
    fuzz::ends_well({Fault::input, Fault::memory}, [&] {
        const Scene scene = room();
        const Solution solution = solve(scene, make_patches(scene), resumed);
        fuzz::require(solution.radiosity.size() == 6, "a value for each patch");
    });
    std::filesystem::remove(file());
    return 0;
}
