#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

#include "parallux/error.h"
#include "scene/input.h"
#include "support/foreign_leaks.h"

// What the fuzz targets share: bytes as numbers, and what must hold whatever they are.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace parallux::fuzz {

/// Ends the process, which the fuzzer takes for a find, unless it holds.
inline void require(bool holds, const char* what) {
    if (holds)
        return;
    std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
    std::abort();
}

/// Runs it; what it throws must be an Error of one of these faults, its message one clean line.
/// Whether it came to its end.
template <class Body>
bool ends_well(std::initializer_list<Fault> faults, Body&& body) {
    try {
        body();
        return true;
    } catch (const Error& error) {
        require(std::find(faults.begin(), faults.end(), error.fault()) != faults.end(),
                "a fault that fits the input");
        const std::string_view what = error.what();
        // What a user has typed is told as typed; complain() escapes it.
        const bool clean = error.fault() == Fault::usage || printable(what, 4096) == what;
        require(!what.empty() && clean, "a message of one clean line");
    }
    return false;
}

/// Numbers made of the input's bytes, zeros once these are used up.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    bool empty() const { return left_ == 0; }
    std::uint8_t byte() { return left_ > 0 ? (--left_, *data_++) : std::uint8_t(0); }
    std::uint32_t word() {
        std::uint32_t value = 0;
        for (int k = 0; k < 4; ++k)
            value |= std::uint32_t(byte()) << (8 * k);
        return value;
    }
    /// 0 … below - 1, below ≤ 256.
    unsigned below(unsigned end) { return byte() % end; }
    /// In [low, high], in 2¹⁶ steps, both ends and the middle among them.
    double real(double low, double high) {
        const unsigned step = byte() | unsigned(byte()) << 8;
        return low + (high - low) * (step == 65535 ? 1 : step / 65536.0);
    }

private:
    const std::uint8_t* data_;
    std::size_t left_;
};

}  // namespace parallux::fuzz
