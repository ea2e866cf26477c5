#include "throughput/engine.h"

#include "throughput/embree_lines.h"
#include "throughput/embree_packets.h"

namespace parallux::throughput {

Measured BundleEngine::run(unsigned threads) {
    Solution solution = solve(case_.scene, case_.patches, case_.settings(threads));
    return {solution.seconds.global, solution.counts, std::move(solution.crossings)};
}

std::vector<std::unique_ptr<Engine>> make_engines(const Case& of, bool whole) {
    std::vector<std::unique_ptr<Engine>> engines;
    engines.push_back(std::make_unique<BundleEngine>(of));
    engines.push_back(std::make_unique<EmbreeLines>(of, Parts::patches, whole));
    engines.push_back(std::make_unique<EmbreeLines>(of, Parts::parents, whole));
    engines.push_back(std::make_unique<EmbreePackets>(of, whole));
    return engines;
}

}  // namespace parallux::throughput
