// SPDX-License-Identifier: Apache-2.0
// How a target composites fragments. Functions take and return vectors of a tile's planes
// (tiles/tile_image.h).
#if defined(LAMINA_TILES_TARGET_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_TARGET_PIXELS_INL_H_
#undef LAMINA_TILES_TARGET_PIXELS_INL_H_
#else
#define LAMINA_TILES_TARGET_PIXELS_INL_H_
#endif

#include "simd/float64-inl.h"
#include "tiles/codes-inl.h"
#include "tiles/dither-inl.h"
#include "tiles/over-inl.h"
#include "tiles/stochastic_over-inl.h"
#include "tiles/target_blend.h"

LAMINA_SIMD_BEGIN

struct Pixels {
    Float red, green, blue, alpha;
};

// The associated colour and the opacity of a vector of fragments or pixels.
struct Fragment {
    Float red, green, blue, alpha;
};

// Rounds towards zero to half precision, as llvmpipe stores floats. Below 2^-14 the last place is
// 2^-24.
LAMINA_INLINE Float truncate_to_half(Float v) {
    const Float normal = bits_as<Float>(bits_as<Word>(v) & ~0x1fffu);
    const Float small = trunc(v * 0x1p24f) * 0x1p-24f;
    const Float half = select(abs(v) < 0x1p-14f, small, normal);
    return min(half, 65504.0f);
}

// The product of two codes of `bits` bits as the blending unit of llvmpipe rounds it.
LAMINA_INLINE Float multiply_codes(int bits, Float a, Float b) {
    if (bits == 8) {
        constexpr float step = 1.0f / 256;
        const Float product = a * b;
        const Float sum = product + floor(product * step);
        return floor((sum + 128.0f) * step);
    }
    const Word product = bits_as<Word>(to_int(a)) * bits_as<Word>(to_int(b));
    const Word sum = product + shift_right<16>(product);
    const Word code = shift_right<16>(sum + 0x8000u);
    return to_float(bits_as<Int>(code));
}

// The code nearest to a colour or opacity.
LAMINA_INLINE Float native_code(float largest, Float value) {
    return round(clamp01(value) * largest);
}

// Blends one channel. `kept`: the share of the pixel that the source leaves visible or, front to
// back, the share of the source that the pixel leaves visible.
LAMINA_INLINE void blend_channel(const TargetBlend& target, Float source, Float kept,
                                 Float& there) {
    const bool behind = target.order == Order::front_to_back;
    if (is_fixed_point(target.target)) {
        const Float product = multiply_codes(target.bits, behind ? source : there, kept);
        const Float sum = product + (behind ? there : source);
        there = min(sum, target.largest);
        return;
    }
    const Float sum = behind ? source * kept + there : there * kept + source;
    there = target.target == Target::float16 ? truncate_to_half(sum) : sum;
}

// Computes what the blending unit of a float32, float16, fixed8 or fixed16 target computes: source
// + there (1 - source alpha), or front to back there + source (1 - there alpha). Fixed-point
// targets round the fragment to codes first, and then the product. All rounding is that of
// llvmpipe.
LAMINA_INLINE void blend(const TargetBlend& target, const Fragment& fragment, Pixels& there) {
    Fragment source = fragment;
    if (is_fixed_point(target.target)) {
        source.red = native_code(target.largest, source.red);
        source.green = native_code(target.largest, source.green);
        source.blue = native_code(target.largest, source.blue);
        source.alpha = native_code(target.largest, source.alpha);
    }
    const Float kept =
        target.largest - (target.order == Order::front_to_back ? there.alpha : source.alpha);
    blend_channel(target, source.red, kept, there.red);
    blend_channel(target, source.green, kept, there.green);
    blend_channel(target, source.blue, kept, there.blue);
    blend_channel(target, source.alpha, kept, there.alpha);
}

// Blends opacity alone.
LAMINA_INLINE void blend_opacity(const TargetBlend& target, Float opacity, Float& there) {
    const Float source =
        is_fixed_point(target.target) ? native_code(target.largest, opacity) : opacity;
    const Float kept = target.largest - (target.order == Order::front_to_back ? there : source);
    blend_channel(target, source, kept, there);
}

// OVER or UNDER of one channel, in floats if they are precise enough.
LAMINA_INLINE Float composite_channel(const TargetBlend& target, Float color, Float alpha,
                                      Float there, Float there_alpha) {
    const bool behind = target.order == Order::front_to_back;
    const int float_bits = behind && target.over_rounding == OverRounding::fused
                               ? max_float_under_bits
                               : max_float_over_bits;
    const auto one_channel = [&](auto c, auto a, auto t, auto ta) LAMINA_LAMBDA {
        const auto largest = static_cast<typename decltype(c)::Scalar>(target.largest);
        return behind ? under(target.over_rounding, c, a, t, ta, largest)
                      : over(target.over_rounding, c, a, t, largest);
    };
    if (target.bits <= float_bits) return one_channel(color, alpha, there, there_alpha);
    return to_float(
        one_channel(Float64(color), Float64(alpha), Float64(there), Float64(there_alpha)));
}

// Programmable blending of codes, as render.emulate says. Colours are not associated.
LAMINA_INLINE void composite_codes(const TargetBlend& target, const Pixels& codes, Pixels& there) {
    const Float before = there.alpha, opaque(target.largest);
    there.red = composite_channel(target, codes.red, codes.alpha, there.red, before);
    there.green = composite_channel(target, codes.green, codes.alpha, there.green, before);
    there.blue = composite_channel(target, codes.blue, codes.alpha, there.blue, before);
    there.alpha = composite_channel(target, opaque, codes.alpha, before, before);
}

LAMINA_INLINE void composite_opacity(const TargetBlend& target, Float alpha, Float& there) {
    there = composite_channel(target, Float(target.largest), alpha, there, there);
}

// Returns the codes of opacities, rounded as render.emulate says. `random`: bits for stochastic
// rounding.
LAMINA_INLINE Float alpha_code(const TargetBlend& target, const Float64& opacity, Word random) {
    const double largest = target.largest;
    return to_float(
        round_alpha(target.alpha_rounding, split_scaled(largest * opacity), Float64(random)));
}

// Returns the codes of opacities or colours in 0..1, dithered along depth. `rank`: rank of the
// slab.
LAMINA_INLINE Float dithered_code(const TargetBlend& target, const Float64& value,
                                  const Dither& dither, std::uint32_t rank) {
    const double largest = target.largest;
    return to_float(dither_code(largest * value, rank, dither.period, dither.increment, largest));
}

// Returns the nearest codes of colours.
LAMINA_INLINE Float color_code(const TargetBlend& target, Float color) {
    const double largest = target.largest;
    return to_float(code_nearest(largest * Float64(clamp01(color))));
}

// OVER in real arithmetic on stored codes. The result is rounded at random, with one random number
// for all channels (compositing/over.h).
LAMINA_INLINE void composite_stochastic(const TargetBlend& target, const Fragment& fragment,
                                        Word random, Pixels& there) {
    const Float64 chance(random), alpha(fragment.alpha);
    const auto channel = [&](Float color, Float& pixel) LAMINA_LAMBDA {
        pixel = to_float(over_stochastic(Float64(clamp01(color)), alpha, Float64(pixel), chance,
                                         static_cast<double>(target.largest)));
    };
    channel(fragment.red, there.red);
    channel(fragment.green, there.green);
    channel(fragment.blue, there.blue);
    channel(fragment.alpha, there.alpha);
}

LAMINA_SIMD_END

#endif
