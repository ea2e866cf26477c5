// Neighbouring lines in the lanes of a vector, for the vector code of each instruction set.

#if defined(PARALLUX_LINES_LINE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_LINES_LINE_LANES_INL_H_
#undef PARALLUX_LINES_LINE_LANES_INL_H_
#else
#define PARALLUX_LINES_LINE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Ints = hn::CappedTag<std::int32_t, 16>;
using Floats = hn::RebindToFloat<Ints>;
using VI = hn::Vec<Ints>;
using VF = hn::Vec<Floats>;
using Lines = hn::Mask<Ints>;

HWY_INLINE std::uint32_t bits_of(Lines lines) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Ints(), lines, bytes);
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
