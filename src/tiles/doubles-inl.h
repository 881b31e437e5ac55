// SPDX-License-Identifier: Apache-2.0
// The numbers of a vector of floats as two vectors of doubles, where floats are not precise enough.
#if defined(LAMINA_TILES_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_DOUBLES_INL_H_
#undef LAMINA_TILES_DOUBLES_INL_H_
#else
#define LAMINA_TILES_DOUBLES_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// `D`: the descriptor of the floats. `low` holds the first half of the lanes.
template <class D>
struct Doubles {
    using Tag = hn::Repartition<double, D>;
    hn::Vec<Tag> low, high;
};

template <class D>
HWY_INLINE Doubles<D> to_doubles(D, hn::Vec<D> v) {
    const typename Doubles<D>::Tag dd;
    const hn::Half<D> half;
    return {hn::PromoteTo(dd, hn::LowerHalf(half, v)), hn::PromoteTo(dd, hn::UpperHalf(half, v))};
}

// Rounds to the nearest float.
template <class D>
HWY_INLINE hn::Vec<D> to_floats(D d, const Doubles<D>& v) {
    const hn::Half<D> half;
    return hn::Combine(d, hn::DemoteTo(half, v.high), hn::DemoteTo(half, v.low));
}

// Converts unsigned whole numbers exactly. It goes through signed ones, for which there is an
// instruction.
template <class D>
HWY_INLINE Doubles<D> to_doubles_of_bits(D, hn::Vec<hn::RebindToUnsigned<D>> bits) {
    const typename Doubles<D>::Tag dd;
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const hn::Half<decltype(di)> half;
    const auto shifted = hn::BitCast(di, hn::Xor(bits, hn::Set(du, 0x80000000u)));
    const auto back = hn::Set(dd, 0x1p31);
    return {hn::Add(hn::PromoteTo(dd, hn::LowerHalf(half, shifted)), back),
            hn::Add(hn::PromoteTo(dd, hn::UpperHalf(half, shifted)), back)};
}

// Applies `f` to each half of one, two or three numbers.
template <class D, class F>
HWY_INLINE Doubles<D> each_half(F f, const Doubles<D>& a) {
    return {f(a.low), f(a.high)};
}
template <class D, class F>
HWY_INLINE Doubles<D> each_half(F f, const Doubles<D>& a, const Doubles<D>& b) {
    return {f(a.low, b.low), f(a.high, b.high)};
}
template <class D, class F>
HWY_INLINE Doubles<D> each_half(F f, const Doubles<D>& a, const Doubles<D>& b,
                                const Doubles<D>& c) {
    return {f(a.low, b.low, c.low), f(a.high, b.high, c.high)};
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
