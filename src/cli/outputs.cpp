#include "cli/outputs.h"

#include <chrono>
#include <exception>
#include <functional>
#include <optional>

#include "output/output_file.h"

namespace parallux {

namespace {

const auto start = std::chrono::steady_clock::now();

/// True when both names mean one file, whether it exists or not.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error) && !error)
        return true;
    auto absolute = [](const std::filesystem::path& file) {
        std::error_code ignored;
        std::filesystem::path full = std::filesystem::weakly_canonical(file, ignored);
        return ignored ? file : full;
    };
    return absolute(a) == absolute(b);
}

// Goes on after a failure, and throws the first one when asked to.
class Attempts {
public:
    void operator()(const std::function<void()>& write) {
        try {
            write();
        } catch (...) {
            if (!failure_)
                failure_ = std::current_exception();
        }
    }
    void rethrow() const {
        if (failure_)
            std::rethrow_exception(failure_);
    }

private:
    std::exception_ptr failure_;
};

// The solution is lent, not copied: it may be most of the memory.
void save(const SolveOptions& options, const Scene& scene, const Patches& patches,
          Solution& solution, double seconds) {
    solution.seconds.total = seconds;
    SavedSolution result{PARALLUX_VERSION, scene_hash(scene, patches), options.scene_arguments,
                         options.solve, std::move(solution)};
    Attempts attempt;
    attempt([&] { write_result(options.save, result); });
    solution = std::move(result.solution);
    attempt.rethrow();
}

void write_lightmaps(const SolveOptions& options, const Scene& scene, const Patches& patches,
                     const Solution& solution) {
    const LightmapSettings& settings = options.lightmap_settings;
    if (!settings.by_object) {
        const Lightmap lightmap = make_lightmap(scene, patches, solution, settings);
        return write_lightmap(options.lightmap, scene, lightmap);
    }
    const auto pictures = object_lightmaps(options.lightmap, scene);
    const Bake mesh = own_uv_mesh(scene, patches, settings);
    Attempts attempt;
    make_object_lightmaps(scene, patches, solution, settings, [&](const Lightmap& lightmap) {
        attempt([&] { write_lightmap_picture(pictures[lightmap.object], scene, lightmap); });
    });
    attempt([&] { write_lightmap_mesh(lightmap_mesh(options.lightmap), scene, mesh, pictures); });
    attempt.rethrow();
}

}  // namespace

double seconds_since_start() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void check_files(const std::vector<std::filesystem::path>& files,
                 const std::vector<std::filesystem::path>& inputs,
                 const std::filesystem::path& scene) {
    for (std::size_t i = 0; i < files.size(); ++i) {
        for (const std::filesystem::path& input : inputs)
            if (same_file(files[i], input))
                throw Error(Fault::usage,
                            files[i].string() +
                                (input == scene ? ": is the scene itself" : ": is read from") +
                                "; choose another output name");
        for (std::size_t j = 0; j < i; ++j)
            if (same_file(files[i], files[j]))
                throw Error(Fault::usage,
                            files[i].string() + ": is named for two outputs; choose another name");
    }
    for (const std::filesystem::path& file : files) {
        check_writable(file);
    }
}

void check_outputs(const SolveOptions& options) {
    check_files(options.outputs(), options.inputs(), options.scene);
}

void check_camera(const SolveOptions& options, Scene& scene) {
    if (options.images.empty())
        return;
    choose_camera(scene, options.camera);
    if (scene.cameras.empty())
        scene.warnings.push_back(
            "the scene has no camera, so the picture shows all of it from outside or within; add "
            "cameras to the scene and choose one with --camera NAME or INDEX");
}

void write_images(const SolveOptions& options, const Scene& scene, const Patches& patches,
                  const Solution& solution) {
    const Picture picture =
        render(scene, patches, solution, choose_camera(scene, options.camera), options.picture);
    Attempts attempt;
    for (const std::filesystem::path& file : options.images)
        attempt([&] { write_picture(file, picture, options.picture); });
    attempt.rethrow();
}

void write_bakes(const SolveOptions& options, const Scene& scene, const Patches& patches,
                 const Solution& solution) {
    // Pictures go into glTF alone: where there are any, PLY has colours of its own.
    Attempts attempt;
    std::optional<Bake> with_pictures, plain;
    for (const std::filesystem::path& file : options.bakes) {
        BakeSettings settings = options.bake;
        settings.textures =
            settings.textures && file.extension() != ".ply" && !scene.textures.empty();
        std::optional<Bake>& bake = settings.textures ? with_pictures : plain;
        if (!bake)
            bake = make_bake(scene, patches, solution, settings);
        attempt([&] { write_bake(file, scene, *bake); });
    }
    attempt.rethrow();
}

void write_outputs(const SolveOptions& options, const Scene& scene, const Patches& patches,
                   Solution& solution, const Measurements& measured) {
    const double before = seconds_since_start();
    Attempts attempt;
    if (!options.save.empty())
        attempt([&] { save(options, scene, patches, solution, before); });
    if (!options.table.empty())
        attempt([&] { write_table(options.table, scene, patches, solution, measured.receivers); });
    if (!options.fluxes.empty())
        attempt([&] { write_fluxes(options.fluxes, measured.fluxes); });
    if (!options.sensor_table.empty())
        attempt([&] {
            const SensorReadings readings =
                sense(scene, patches, solution, measured.sensors, options.sensing);
            write_sensors(options.sensor_table, measured.sensors, readings);
        });
    if (!options.images.empty())
        attempt([&] { write_images(options, scene, patches, solution); });
    if (!options.bakes.empty())
        attempt([&] { write_bakes(options, scene, patches, solution); });
    if (!options.lightmap.empty())
        attempt([&] { write_lightmaps(options, scene, patches, solution); });
    if (options.result.empty()) {  // else the times are those of the solve
        solution.seconds.total = seconds_since_start();
        solution.seconds.output = solution.seconds.total - before;
    }
    if (!options.stats.empty())
        attempt([&] { write_stats(options.stats, scene, patches, options.solve, solution); });
    attempt.rethrow();
}

}  // namespace parallux
