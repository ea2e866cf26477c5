#include "throughput/engine.h"

#include "throughput/apart.h"
#include "throughput/embree_lines.h"
#include "throughput/embree_packets.h"

namespace parallux::throughput {

Measured BundleEngine::run(unsigned threads) {
    Solution solution = solve(case_.scene, case_.patches, case_.settings(threads));
    return {solution.seconds.global, solution.counts, std::move(solution.crossings),
            solution.seconds.serial};
}

const std::vector<std::string>& engine_names() {
    static const std::vector<std::string> names{"bundle", "bundle-apart", "embree-lines",
                                                "embree-lines-parents", "embree-packets"};
    return names;
}

std::unique_ptr<Engine> make_engine(const std::string& name, const Case& of, bool whole) {
    if (name == "embree-lines")
        return std::make_unique<EmbreeLines>(of, Parts::patches, whole);
    if (name == "embree-lines-parents")
        return std::make_unique<EmbreeLines>(of, Parts::parents, whole);
    if (name == "embree-packets")
        return std::make_unique<EmbreePackets>(of, whole);
    if (name == "bundle-apart")
        return std::make_unique<ApartEngine>(of);
    return std::make_unique<BundleEngine>(of);
}

}  // namespace parallux::throughput
