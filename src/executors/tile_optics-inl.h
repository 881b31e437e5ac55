// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/intervals.glsl and transfer_function.glsl.
#if defined(LAMINA_EXECUTORS_TILE_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#undef LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "executors/tile_transfer.h"
#include "executors/tile_vectors-inl.h"
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// How the interval of a scalar is looked up. one: there is only one interval. permute: by
// permutations of vectors that hold all intervals. gather: by gathers from memory.
enum class Lookup { one, permute, gather };

// Calls body(std::integral_constant<Lookup, ...>).
template <class Body>
HWY_INLINE void with_lookup(const TileTransfer& transfer, const Body& body) {
    const auto lanes = static_cast<int>(hn::Lanes(FloatTag()));
    if (transfer.intervals == 1) {
        body(std::integral_constant<Lookup, Lookup::one>());
    } else if (transfer.intervals <= lanes) {
        body(std::integral_constant<Lookup, Lookup::permute>());
    } else {
        body(std::integral_constant<Lookup, Lookup::gather>());
    }
}

template <Lookup kind>
HWY_INLINE Floats look_up(const std::vector<float>& values, Ints interval) {
    const FloatTag d;
    if constexpr (kind == Lookup::one) {
        return hn::Set(d, values[0]);
    } else if constexpr (kind == Lookup::permute) {
        return hn::TableLookupLanes(hn::LoadU(d, values.data()), hn::IndicesFromVec(d, interval));
    } else {
        return hn::GatherIndex(d, values.data(), interval);
    }
}

// The interval that holds a scalar in [0, 1]. At the value of a step it is the upper one.
template <Lookup kind>
HWY_INLINE Ints find_interval(const TileTransfer& transfer, Floats scalar) {
    const FloatTag d;
    const IntTag di;
    Ints interval = hn::Zero(di);
    if constexpr (kind == Lookup::one) return interval;
    const Ints one = hn::Set(di, 1);
    if (kind == Lookup::permute || transfer.intervals <= TileTransfer::few) {
        for (int i = 1; i < transfer.intervals; ++i) {
            const auto beyond =
                hn::Ge(scalar, hn::Set(d, transfer.end[static_cast<std::size_t>(i)]));
            interval = hn::Add(interval, hn::IfThenElseZero(hn::RebindMask(di, beyond), one));
        }
        return interval;
    }
    const auto cell =
        hn::Min(hn::ConvertTo(di, hn::Mul(scalar, hn::Set(d, 1024.0f))), hn::Set(di, 1023));
    interval = hn::GatherIndex(di, transfer.starts.data(), cell);
    const Ints last = hn::Set(di, transfer.intervals - 1);
    while (true) {
        const Floats next = hn::GatherIndex(d, transfer.end.data() + 1, interval);
        const auto beyond =
            hn::And(hn::RebindMask(di, hn::Ge(scalar, next)), hn::Lt(interval, last));
        if (hn::AllFalse(di, beyond)) return interval;
        interval = hn::Add(interval, hn::IfThenElseZero(beyond, one));
    }
}

// The position of a scalar in its interval, 0 to 1.
template <Lookup kind>
HWY_INLINE Floats share_of_interval(const TileTransfer& transfer, Ints interval, Floats scalar) {
    const Floats end = look_up<kind>(transfer.end, interval);
    return clamp01(FloatTag(),
                   hn::Mul(hn::Sub(scalar, end), look_up<kind>(transfer.inverse_width, interval)));
}

template <Lookup kind>
HWY_INLINE Floats optics_at(const TileTransfer& transfer, std::size_t channel, Ints interval,
                            Floats share) {
    return mul_add(share, look_up<kind>(transfer.change[channel], interval),
                   look_up<kind>(transfer.left[channel], interval));
}

// Whether there is extinction anywhere from a scalar, which interval `first` holds, to `largest`:
// in an interval before the last one, or in the last one. The last interval does not count where
// `largest` is its left end and the extinction there is 0.
template <Lookup kind>
HWY_INLINE FloatMask shows_something(const TileTransfer& transfer, Ints first, Floats largest) {
    const Ints last = find_interval<kind>(transfer, largest);
    const auto before = hn::Gt(look_up<kind>(transfer.shown_before, last),
                               look_up<kind>(transfer.shown_before, first));
    return hn::Or(before, hn::Gt(largest, look_up<kind>(transfer.shown_beyond, last)));
}

// The extinction, in double precision.
template <Lookup kind>
HWY_INLINE TwoDoubles precise_extinction_at(const TileTransfer& transfer, Ints interval,
                                            Floats share) {
    const auto sum = [&](const std::vector<float>& value, const std::vector<float>& rest) HWY_ATTR {
        const auto add = [](HalfDoubles a, HalfDoubles b) HWY_ATTR { return hn::Add(a, b); };
        return each_half<FloatTag>(add, to_doubles(FloatTag(), look_up<kind>(value, interval)),
                                   to_doubles(FloatTag(), look_up<kind>(rest, interval)));
    };
    const auto between = [](HalfDoubles left, HalfDoubles right, HalfDoubles at)
                             HWY_ATTR { return hn::Add(left, hn::Mul(at, hn::Sub(right, left))); };
    return each_half<FloatTag>(between, sum(transfer.left[3], transfer.left_rest),
                               sum(transfer.right_extinction, transfer.right_rest),
                               to_doubles(FloatTag(), share));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
