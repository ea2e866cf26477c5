#include "solve/pass.h"

#include <cmath>

namespace parallux {

void set_emission(const Run& run, const DirectLight& direct, TransferState& state) {
    for (std::size_t k = 0; k < direct.unshot.size(); ++k)
        state.emission[k] = std::llrint(static_cast<double>(direct.unshot[k]) /
                                        run.patches.area[k / state.bands] * run.plan.emission_cell);
}

SkyQuanta sky_quanta(const Scene& scene, const Plan& plan, const glm::dvec3& direction) {
    SkyQuanta quanta;
    Spectrum behind = scene.sky.radiance(-direction), ahead = scene.sky.radiance(direction);
    double unit = plan.emission_cell * pi / plan.watts_per_quantum;
    for (std::uint32_t band = 0; band < scene.bands; ++band) {
        quanta.along[band] = std::llrint(unit * behind[band]);
        quanta.against[band] = std::llrint(unit * ahead[band]);
    }
    return quanta;
}

}  // namespace parallux
