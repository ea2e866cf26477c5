#include "solve/in_order_pass.h"

#include "lines/line_stream.h"

namespace parallux {

PassResult in_order_pass(const Run& run, DirectLight& direct, TransferState& state) {
    const bool lit = run.scene.sky.kind != Sky::Kind::dark;
    const std::uint64_t lines = run.plan.lines;
    settle(run, direct);
    state.emission = emission_of(run.patches, direct);
    state.emission.quanta = emission_quanta(run.plan, state);
    run.banks.join(run.plan.threads);
    PassResult result;
    std::vector<SkyQuanta> sky;
    LineStream stream{*run.rays,         run.scene, run.patches, run.plan.sphere,
                      run.settings.seed, lines,     lit,         run.plan.threads};
    std::uint64_t done =
        trace_in_order(stream, [&](const IntersectionLists& lists,
                                   const std::vector<glm::dvec3>& directions, std::uint64_t) {
            sky.clear();
            for (const glm::dvec3& direction : directions)
                sky.push_back(sky_quanta(run.scene, state.emission.quanta, direction));
            exchange_in_order(lists, state, run.banks.of(0), run.patches, run.settings.direction,
                              sky, result.counts);
            return run.listener.go_on(
                "lines", static_cast<double>(result.counts.lines) / static_cast<double>(lines),
                result.counts.lines);
        });
    result.done = static_cast<double>(done) / static_cast<double>(lines);
    result.whole = done == lines;
    return result;
}

}  // namespace parallux
