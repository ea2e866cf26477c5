#include "fuzz.h"
#include "output/checksum.h"
#include "output/result_fields.h"

// The input is a whole file, or the fields of one, which then gets the head and checksum that
// would else turn away nearly every input. A second format (checkpoints) gets a target like this.

using namespace parallux;

namespace {

template <class T>
std::string raw(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string whole(const std::string& fields) {
    std::string bytes = std::string(result_magic, sizeof result_magic - 1) + raw(result_format) +
                        raw(std::uint64_t(result_head + fields.size() + 8)) + fields;
    Checksum sum;
    sum.add(bytes);
    return bytes + raw(sum.value());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (bytes.compare(0, 4, "PLXR") != 0)
        bytes = whole(bytes);
    fuzz::ends_well({Fault::input, Fault::memory}, [&] {
        const SavedSolution result = result_of("room.plx", bytes);
        for (const auto* values :
             {&result.solution.radiosity, &result.solution.irradiance, &result.solution.stderror})
            for (float value : *values)
                fuzz::require(std::isfinite(value), "values are finite");
        fuzz::require(result.settings.method <= Method::matrix, "a method that is one");
    });
    return 0;
}
