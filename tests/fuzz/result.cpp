#include "fuzz.h"
#include "output/result_fields.h"
#include "sealed_bytes.h"

// The input is a whole file, or the fields of one, which then gets the head and checksum that
// would else turn away nearly every input.

using namespace parallux;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(data), size);
    if (bytes.compare(0, 4, "PLXR") != 0)
        bytes = fuzz::sealed(result_kind, bytes);
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
