#include "solve/memory.h"

#include <algorithm>
#include <string>

#include <unistd.h>

#include "lines/facets.h"
#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "reference/matrix.h"
#include "solve/checkpoint.h"
#include "solve/emitters.h"
#include "solve/keeping.h"
#include "solve/plan_lines.h"
#include "solve/plan_shots.h"
#include "solve/shot_exact.h"
#include "solve/sources.h"
#include "transfer/banks.h"
#include "transfer/partition.h"

namespace parallux {

namespace {

std::uint64_t machine_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
}

// How many groups there will be, and how direct light will be found.
Plan planned(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    Plan plan;
    plan.sphere = line_sphere(scene, settings.sphere_radius);
    plan_lines(patches, settings, plan);
    SolveSettings shots = settings;
    if (is_periodic(scene))
        shots.first_shot = FirstShot::off;
    plan_shots(scene, patches, shots, plan);
    return plan;
}

// Bytes of the stages that follow one another, and what they all work on.
struct Footprint {
    const Scene& scene;
    const Patches& patches;
    const SolveSettings& settings;
    std::uint64_t count = patches.count();
    std::uint32_t bands = patches.bands;
    unsigned threads = thread_count(settings.threads);
    unsigned banks = Banks::count(count, bands, threads, bank_limit(settings));
    bool local = needs_rays(scene, patches, settings);
    Plan plan = planned(scene, patches, settings);
    bool exact = local && plan.first_shot == FirstShot::exact;

    // The program with its libraries; surfaces as read, and the ray tracer's own copy of them with
    // its tree.
    std::uint64_t loaded() const {
        return (std::uint64_t(132) << 20) + count * (8 + bands * 8) +
               (patches.translucent() ? count * (4 + bands * 4) : 0) +
               scene.surfaces.size() * (sizeof(Surface) + sizeof(SurfaceGrid) + 200) +
               scene.positions.size() * (sizeof(glm::dvec3) + 12);
    }
    std::uint64_t all_banks() const { return banks * Banks::bytes_a_bank(count, bands); }
    // Direct light: an irradiance. Single shots: what they took, and the exitance they leave.
    std::uint64_t direct() const {
        return count * ((local ? bands * 4 : 0) + (settings.shots > 0 ? bands * 4 : 0));
    }
    // Mean and spread of the groups before.
    std::uint64_t groups() const {
        if (plan.groups == 1 && settings.target_error <= 0)
            return 0;
        // Freed arrays of less than 32 MiB may lie between others, and stay with the process.
        const std::uint64_t between = std::min(count * 16, std::uint64_t(32) << 20);
        return count * (bands * 8 + 8) + between;
    }
    // A checkpoint lies in memory while it is written, or read.
    std::uint64_t checkpoint() const {
        return settings.checkpoints.any() ? checkpoint_bytes(count, bands) : 0;
    }
    // All cells, and what each source sees of them, from the beginning to the end.
    std::uint64_t views() const {
        const std::uint64_t a_view = ExactShot::bytes_a_cell();
        return exact ? count * (sizeof(Emitter) + count_sources(scene, patches) * a_view) : 0;
    }
    // Each patch's region. The cells that send, with their power and that of their rays, and of
    // exact shots one view more while it is made.
    std::uint64_t first_shot() const {
        std::uint64_t cells = 0;
        for (std::size_t patch = 0; local && patch < count; ++patch)
            cells += std::any_of(&patches.emission[patch * bands],
                                 &patches.emission[patch * bands] + bands,
                                 [](float emission) { return emission > 0; });
        const bool all = settings.shots > 0 || settings.method == Method::progressive ||
                         settings.method == Method::particles;
        return all_banks() + groups() + count * 4 + cells * (sizeof(Emitter) + bands * 16 + 12) +
               (all ? count * (100 + bands * 12) : 0) +
               (exact ? views() + count * ExactShot::bytes_a_cell() : 0);
    }
    // What was sent, what exits carry, pairs on their way, and those kept. A projection holds
    // corners, and each surface in a tile or two.
    std::uint64_t pass() const {
        std::uint64_t projections = settings.method == Method::bundles ? 16 : 0;
        return all_banks() + direct() + groups() + views() +
               count * (bands * 8 + lanes(bands) * 4) + keeping_bytes(count, bands) +
               (banks < threads ? Partition::bytes(threads) : 0) +
               projections * (scene.surfaces.size() * 8 + scene.positions.size() * 12) +
               (projections ? facets_bytes(scene, patches, plan.spacing, projections) : 0) +
               (banks < threads ? 1 : threads) * copies_bytes(scene) +
               (settings.method == Method::matrix ? matrix_bytes(count) : 0);
    }
    // Regions, irradiance and crossings beside what exits carry; radiosity in its place once that
    // is over.
    std::uint64_t gather() const {
        return all_banks() + direct() + groups() + views() + count * (bands * 4 + 12) +
               count * std::max(lanes(bands) * 4, bands * 4);
    }
};

}  // namespace

std::uint64_t predicted_memory(const Scene& scene, const Patches& patches,
                               const SolveSettings& settings) {
    const Footprint footprint{scene, patches, settings};
    const std::uint64_t counted =
        footprint.loaded() + footprint.checkpoint() +
        std::max({footprint.first_shot(), footprint.pass(), footprint.gather()});
    // Small rows that nobody counts, and pieces between.
    return counted + counted / 32;
}

std::uint64_t bank_limit(const SolveSettings& settings) {
    std::uint64_t limit = std::uint64_t(1) << 28;
    return settings.max_memory ? std::min(limit, settings.max_memory / 4) : limit;
}

void check_memory(const Scene& scene, const Patches& patches, const SolveSettings& settings) {
    std::uint64_t need = predicted_memory(scene, patches, settings), limit = settings.max_memory;
    if (settings.method == Method::matrix)
        limit = limit ? std::min(limit, machine_memory()) : machine_memory();
    if (limit == 0 || need <= limit)
        return;
    std::string what = "this run needs about " + std::to_string((need >> 20) + 1) +
                       " MiB, more than the " + std::to_string(limit >> 20) + " MiB allowed; ";
    if (settings.method == Method::matrix)
        throw Error(Fault::memory, what +
                                       "the matrix grows with the square of the patches: choose "
                                       "larger patches or another --method");
    throw Error(Fault::memory, what + "choose larger patches or raise --max-memory");
}

}  // namespace parallux
