// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/intervals.glsl and transfer_function.glsl.
#if defined(LAMINA_EXECUTORS_TILE_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#undef LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_OPTICS_INL_H_
#endif

#include <type_traits>

#include "executors/tile_transfer.h"
#include "simd/float64-inl.h"

LAMINA_SIMD_BEGIN

// Ways to look up the interval of a scalar. one: there is only one interval. permute: by
// permutations of vectors that hold all intervals. gather: by gathers from memory.
enum class Lookup { one, permute, gather };

// Calls body(std::integral_constant<Lookup, ...>).
template <class Body>
LAMINA_INLINE void with_lookup(const TileTransfer& transfer, const Body& body) {
    if (transfer.intervals == 1) {
        body(std::integral_constant<Lookup, Lookup::one>());
    } else if (transfer.intervals <= static_cast<int>(Float::lanes)) {
        body(std::integral_constant<Lookup, Lookup::permute>());
    } else {
        body(std::integral_constant<Lookup, Lookup::gather>());
    }
}

template <Lookup kind>
LAMINA_INLINE Float look_up(const std::vector<float>& values, Int interval) {
    if constexpr (kind == Lookup::one) {
        return Float(values[0]);
    } else if constexpr (kind == Lookup::permute) {
        return permute(load_unaligned<Float>(values.data()), interval);
    } else {
        return gather(values.data(), interval);
    }
}

// Returns the interval that holds a scalar in [0, 1]. At the value of a step it is the upper one.
template <Lookup kind>
LAMINA_INLINE Int find_interval(const TileTransfer& transfer, Float scalar) {
    Int interval(0);
    if constexpr (kind == Lookup::one) return interval;
    if (kind == Lookup::permute || transfer.intervals <= TileTransfer::few) {
        for (int i = 1; i < transfer.intervals; ++i) {
            const FloatMask beyond = scalar >= transfer.left_end[static_cast<std::size_t>(i)];
            interval += zero_unless(beyond, Int(1));
        }
        return interval;
    }
    const Int cell = min(to_int(scalar * 1024.0f), 1023);
    interval = gather(transfer.starts.data(), cell);
    const Int last(transfer.intervals - 1);
    while (true) {
        const Float next = gather(transfer.left_end.data() + 1, interval);
        const FloatMask beyond = (scalar >= next) & (interval < last);
        if (none_of(beyond)) return interval;
        interval += zero_unless(beyond, Int(1));
    }
}

// Returns the position of a scalar in its interval, 0 to 1.
template <Lookup kind>
LAMINA_INLINE Float share_of_interval(const TileTransfer& transfer, Int interval, Float scalar) {
    const Float end = look_up<kind>(transfer.left_end, interval);
    return clamp01((scalar - end) * look_up<kind>(transfer.inverse_width, interval));
}

template <Lookup kind>
LAMINA_INLINE Float optics_at(const TileTransfer& transfer, std::size_t channel, Int interval,
                              Float share) {
    return share * look_up<kind>(transfer.change[channel], interval) +
           look_up<kind>(transfer.left[channel], interval);
}

// Tells whether extinction is > 0 anywhere from a scalar, which interval `first` holds, to
// `largest`: in an interval before the last one, or in the last one. The last interval does not
// count if `largest` is its left end and the extinction there is 0.
template <Lookup kind>
LAMINA_INLINE FloatMask shows_something(const TileTransfer& transfer, Int first, Float largest) {
    const Int last = find_interval<kind>(transfer, largest);
    const FloatMask before =
        look_up<kind>(transfer.shown_before, last) > look_up<kind>(transfer.shown_before, first);
    return before | (largest > look_up<kind>(transfer.shown_beyond, last));
}

// Returns the extinction in double precision.
template <Lookup kind>
LAMINA_INLINE Float64 precise_extinction_at(const TileTransfer& transfer, Int interval,
                                            Float share) {
    const auto sum = [&](const std::vector<float>& value,
                         const std::vector<float>& rest) LAMINA_LAMBDA {
        return Float64(look_up<kind>(value, interval)) + Float64(look_up<kind>(rest, interval));
    };
    const Float64 left = sum(transfer.left[3], transfer.left_rest);
    const Float64 right = sum(transfer.right_extinction, transfer.right_rest);
    return left + Float64(share) * (right - left);
}

LAMINA_SIMD_END

#endif
