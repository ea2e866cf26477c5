// Included once for every instruction set, by files that Highway compiles for each.
#if defined(PARALLUX_SOME_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PARALLUX_SOME_LANES_INL_H
#undef PARALLUX_SOME_LANES_INL_H
#else
#define PARALLUX_SOME_LANES_INL_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace parallux {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

template <std::size_t n, class D>
hn::Vec<D> load_some(D d, const hn::TFromD<D>* values) {
    return hn::LoadU(d, values);
}

template <std::size_t n, class D>
void store_some(D d, hn::Vec<D> v, hn::TFromD<D>* values) {
    hn::StoreU(v, d, values);
}

// Of whole numbers of 32 bits, in 64.
template <class D>
hn::Vec<D> product(D d, hn::Vec<D> a, hn::Vec<D> b) {
    return hn::Set(d, hn::GetLane(a) * hn::GetLane(b));
}

#else

// The first n of a vector's values; the others hold some value of the same array.
template <std::size_t n, class D>
HWY_INLINE hn::Vec<D> load_some(D d, const hn::TFromD<D>* values) {
    const hn::Half<D> half;
    if constexpr (n == 1)
        return hn::Set(d, values[0]);
    else if constexpr (n == 2 && hn::MaxLanes(D()) == 4)
        return hn::Combine(d, hn::LoadU(half, values), hn::LoadU(half, values));
    else if constexpr (n == 3)
        return hn::Combine(d, hn::Reverse(half, hn::LoadU(half, values + 1)),
                           hn::LoadU(half, values));
    else
        return hn::LoadU(d, values);
}

template <std::size_t n, class D>
HWY_INLINE void store_some(D d, hn::Vec<D> v, hn::TFromD<D>* values) {
    const hn::Half<D> half;
    if constexpr (n == 1) {
        values[0] = hn::GetLane(v);
    } else if constexpr (n == 2 && hn::MaxLanes(D()) == 4) {
        hn::StoreU(hn::LowerHalf(half, v), half, values);
    } else if constexpr (n == 3) {
        hn::StoreU(hn::LowerHalf(half, v), half, values);
        values[2] = hn::ExtractLane(v, 2);
    } else {
        hn::StoreU(v, d, values);
    }
}

// Of whole numbers of 32 bits, in 64.
template <class D>
HWY_INLINE hn::Vec<D> product(D d, hn::Vec<D> a, hn::Vec<D> b) {
    const hn::Repartition<std::int32_t, D> both;
    return hn::BitCast(d, hn::MulEven(hn::BitCast(both, a), hn::BitCast(both, b)));
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace parallux
HWY_AFTER_NAMESPACE();

#endif
