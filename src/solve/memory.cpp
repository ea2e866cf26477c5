#include "solve/memory.h"

#include <algorithm>
#include <string>

#include <unistd.h>

#include "lines/periodic.h"
#include "parallel.h"
#include "parallux/error.h"
#include "reference/matrix.h"
#include "solve/checkpoint.h"
#include "solve/emitters.h"
#include "solve/keeping.h"
#include "solve/plan_shots.h"
#include "transfer/banks.h"
#include "transfer/partition.h"

namespace parallux {

namespace {

std::uint64_t machine_memory() {
    return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
           static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
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
        const bool several = settings.method == Method::bundles && settings.groups != 1;
        return several ? count * (bands * 8 + 8) : 0;
    }
    // A checkpoint lies in memory while it is written, or read.
    std::uint64_t checkpoint() const {
        return settings.checkpoints.any() ? checkpoint_bytes(count, bands) : 0;
    }
    // The cells that send, with their power.
    std::uint64_t first_shot() const {
        std::uint64_t cells = 0;
        for (std::size_t patch = 0; local && patch < count; ++patch)
            cells += std::any_of(&patches.emission[patch * bands],
                                 &patches.emission[patch * bands] + bands,
                                 [](float emission) { return emission > 0; });
        bool all = settings.shots > 0 || settings.method == Method::progressive ||
                   settings.method == Method::particles || settings.first_shot == FirstShot::exact;
        return all_banks() + groups() + cells * (sizeof(Emitter) + bands * 8 + 8) +
               (all ? count * (100 + bands * 12) : 0);
    }
    // What was sent, what exits carry, pairs on their way, and those kept. A projection holds
    // corners, and each surface in a tile or two.
    std::uint64_t pass() const {
        std::uint64_t projections = settings.method == Method::bundles ? 16 : 0;
        return all_banks() + direct() + groups() + count * (bands * 8 + lanes(bands) * 4) +
               keeping_bytes(count, bands) + (banks < threads ? Partition::bytes(threads) : 0) +
               projections * (scene.surfaces.size() * 8 + scene.positions.size() * 12) +
               (banks < threads ? 1 : threads) * copies_bytes(scene) +
               (settings.method == Method::matrix ? matrix_bytes(count) : 0);
    }
    // Irradiance and crossings beside what exits carry; radiosity in its place once that is over.
    std::uint64_t gather() const {
        return all_banks() + direct() + groups() + count * (bands * 4 + 8) +
               count * std::max(lanes(bands) * 4, bands * 4);
    }
};

}  // namespace

std::uint64_t predicted_memory(const Scene& scene, const Patches& patches,
                               const SolveSettings& settings) {
    const Footprint footprint{scene, patches, settings};
    return footprint.loaded() + footprint.checkpoint() +
           std::max({footprint.first_shot(), footprint.pass(), footprint.gather()});
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
