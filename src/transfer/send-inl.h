// Included once for every instruction set, by files that Highway compiles for each.
#if defined(PARALLUX_SEND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_SEND_INL_H
#undef PARALLUX_SEND_INL_H
#else
#define PARALLUX_SEND_INL_H
#endif

#include <hwy/highway.h>

#include "parallux/transfer.h"

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Adds what an exit carries to what a patch has received, and `exits` behind the bands.
template <std::uint32_t bands>
HWY_INLINE void send(const std::int32_t* HWY_RESTRICT carried, std::int64_t* HWY_RESTRICT received,
                     std::int64_t exits = 1) {
    constexpr std::uint32_t count = lanes(bands);
    const hn::CappedTag<std::int64_t, count == 12 ? 4 : count> d;
    const hn::Rebind<std::int32_t, decltype(d)> half;
    for (std::size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
        auto sent = hn::PromoteTo(d, hn::Load(half, carried + lane));
        if (lane <= bands && bands < lane + hn::Lanes(d)) {
            const auto own = hn::Set(d, static_cast<std::int64_t>(bands - lane));
            sent = hn::IfThenElse(hn::Eq(hn::Iota(d, 0), own), hn::Set(d, exits), sent);
        }
        hn::Store(hn::Add(hn::Load(d, received + lane), sent), d, received + lane);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
