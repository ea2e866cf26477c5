#include <vector>

#include "fuzz.h"
#include "lines/sort_hits.h"

using namespace parallux;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes(data, size);
    std::vector<float> slack(16);
    for (float& s : slack)
        s = static_cast<float>(bytes.below(4)) * 0x1p-20f;
    const float tie = static_cast<float>(bytes.below(4)) * 0x1p-20f;
    std::vector<Hit> hits;
    while (!bytes.empty()) {
        Hit hit;
        // Coarse steps about 0, so that equal depths and near ones are common.
        hit.depth = static_cast<float>(static_cast<int>(bytes.below(64)) - 32) * 0x1p-20f;
        hit.surface = bytes.below(16);
        hit.toward = static_cast<std::uint32_t>(hits.size());  // who it was
        hits.push_back(hit);
    }
    std::vector<Hit> expected = hits;
    std::stable_sort(expected.begin(), expected.end(), before);
    const bool near = sort_hits(hits.data(), hits.data() + hits.size(), tie, slack);
    bool any_near = false;
    std::vector<bool> seen(hits.size());
    for (std::size_t k = 0; k < hits.size(); ++k) {
        fuzz::require(hits[k].depth == expected[k].depth && hits[k].surface == expected[k].surface,
                      "the order of an ordinary sort");
        fuzz::require(!seen[hits[k].toward], "no hit twice");
        seen[hits[k].toward] = true;
        if (k > 0) {
            const float step = hits[k].depth - hits[k - 1].depth;
            any_near = any_near || step < tie ||
                       step < slack[hits[k].surface] + slack[hits[k - 1].surface];
        }
    }
    fuzz::require(near == any_near, "near ones are told");
    return 0;
}
