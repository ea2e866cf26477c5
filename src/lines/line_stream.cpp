#include "lines/line_stream.h"

#include <algorithm>

#include "parallel.h"

namespace parallux {

namespace {
constexpr std::uint64_t lines_a_piece = 4096;
}

std::uint64_t trace_in_order(
    const LineStream& stream,
    const std::function<bool(const IntersectionLists&, const std::vector<glm::dvec3>&,
                             std::uint64_t)>& follow) {
    // Each round traces some pieces a thread side by side, then follows them one by one.
    unsigned threads = thread_count(stream.threads);
    std::size_t pieces = threads == 1 ? 1 : 4 * std::size_t(threads);
    std::vector<IntersectionLists> lists(pieces);
    std::vector<std::vector<glm::dvec3>> directions(pieces);
    std::uint64_t done = 0;
    while (done < stream.lines) {
        std::uint64_t left = stream.lines - done;
        std::size_t count = static_cast<std::size_t>(
            std::min<std::uint64_t>(pieces, (left - 1) / lines_a_piece + 1));
        auto size_of = [&](std::size_t piece) {
            return static_cast<std::size_t>(std::min(lines_a_piece, left - piece * lines_a_piece));
        };
        parallel_for(threads, count, 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k)
                trace_lines(stream.rays, stream.scene, stream.patches, stream.sphere, stream.seed,
                            done + k * lines_a_piece, size_of(k), lists[k],
                            stream.directions ? &directions[k] : nullptr);
        });
        for (std::size_t k = 0; k < count; ++k) {
            std::uint64_t before = done;
            done += lists[k].lines();
            if (!follow(lists[k], directions[k], before))
                return done;
        }
    }
    return done;
}

}  // namespace parallux
