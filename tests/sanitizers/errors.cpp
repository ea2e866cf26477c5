#include <cstdio>
#include <cstring>
#include <limits>

#include "parallel.h"
#include "transfer/banks.h"

// errors KIND makes one error of a kind in the library's own code, by misusing it: a sanitizer that
// does not tell it would not tell any other either. Ends with code 0 when nobody notices.

using namespace parallux;

int main(int argc, char** argv) {
    const char* kind = argc > 1 ? argv[1] : "";
    constexpr std::size_t patches = 4;
    Banks banks(patches, 1, 1, std::numeric_limits<std::uint64_t>::max());
    if (std::strcmp(kind, "overrun") == 0) {
        banks.receive(0, 16 * patches, 1);
    } else if (std::strcmp(kind, "overflow") == 0) {
        banks.receive(0, 0, std::numeric_limits<std::int64_t>::max());
        banks.receive(0, 0, 1);
    } else if (std::strcmp(kind, "leak") == 0) {
        [[maybe_unused]] Banks* volatile lost = new Banks(1 << 16, 1, 1, 1 << 30);
        lost = nullptr;
    } else if (std::strcmp(kind, "race") == 0) {
        parallel_for(2, 1 << 16, 16, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k)
                banks.receive(0, k % patches, 1);
        });
    } else {
        std::fprintf(stderr, "usage: errors overrun|overflow|leak|race\n");
        return 2;
    }
    std::printf("%lld\n", static_cast<long long>(banks.received(0, 0)));
    return 0;
}
