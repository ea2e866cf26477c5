#include "solve/sources.h"

#include <algorithm>

namespace parallux {

std::vector<Source> sources_of(const Scene& scene, const Patches& patches,
                               const Emitters& emitters) {
    std::vector<Source> sources;
    const std::uint32_t bands = emitters.bands;
    auto power_of = [&](std::size_t piece) { return &emitters.power[piece * bands]; };
    for (std::size_t first = 0; first < emitters.pieces.size();) {
        const Emitter& piece = emitters.pieces[first];
        std::size_t end = first;
        bool alike = true;
        while (end < emitters.pieces.size() && emitters.pieces[end].surface == piece.surface &&
               emitters.pieces[end].back == piece.back) {
            alike = alike && std::equal(power_of(end), power_of(end) + bands, power_of(first));
            ++end;
        }
        const SurfaceGrid& grid = patches.grids[piece.surface];
        if (alike && end - first == std::size_t(grid.nu) * grid.nv) {
            Emitter whole = piece;
            whole.cell = {0, 0, 0, 0.5, 0.5, 0, 0, 1, 1};
            Source source{polygon_of(scene, whole), whole, {}};
            for (std::uint32_t band = 0; band < bands; ++band)
                source.power.push_back(static_cast<double>(end - first) * power_of(first)[band]);
            sources.push_back(source);
        } else {
            for (std::size_t k = first; k < end; ++k)
                sources.push_back({polygon_of(scene, emitters.pieces[k]),
                                   emitters.pieces[k],
                                   {power_of(k), power_of(k) + bands}});
        }
        first = end;
    }
    return sources;
}

std::uint64_t count_sources(const Scene& scene, const Patches& patches) {
    const std::uint32_t bands = patches.bands;
    std::uint64_t count = 0;
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
        const SurfaceGrid& grid = patches.grids[s];
        const std::size_t cells = std::size_t(grid.nu) * grid.nv;
        for (std::uint32_t first : {grid.front, grid.back}) {
            if (first == none)
                continue;
            const float* own = &patches.emission[std::size_t(first) * bands];
            std::uint64_t emitting = 0;
            bool alike = true;
            for (std::size_t cell = 0; cell < cells; ++cell) {
                const float* values = own + cell * bands;
                emitting += std::any_of(values, values + bands, [](float e) { return e > 0; });
                alike = alike && std::equal(values, values + bands, own);
            }
            count += alike ? std::min<std::uint64_t>(emitting, 1) : emitting;
        }
    }
    return count;
}

}  // namespace parallux
